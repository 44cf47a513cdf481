#pragma once

#include <string>
#include <utility>
#include <vector>

#include <talus/planner/route/route.hpp>

namespace talus::cli {

/// Map distance from the start to each vertex [m].
std::vector<double> distances_m(const planner::Route& route);

/// The ten lines that a rover engineer wants of a route: what, and its value with unit; fewer where a
/// quantity is not known. For a route that was not found, its status and reason.
std::vector<std::pair<std::string, std::string>> summaryOf(const planner::Route& route);

/// The same as aligned text, a line each.
std::string summaryText(const planner::Route& route);

/// Joules as J, kJ or MJ, four digits.
std::string energyText(double joules);

/// "2 h 05 min", "45 s", "3 d 04 h".
std::string durationText(double seconds);

}  // namespace talus::cli
