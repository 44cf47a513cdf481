#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/planner/route/route.hpp>

namespace talus::cli {

/// Map distance from the start to each vertex [m].
std::vector<double> distances_m(const planner::Route& route);

/// The summary of a route, ten quantities, each with its value and unit; fewer where one is not known. For a
/// route that was not found, its status and reason.
std::vector<std::pair<std::string, std::string>> summaryOf(const planner::Route& route);

/// One aligned line of text: a quantity and its value.
std::string summaryLine(std::string_view what, std::string_view value);

/// The summary as lines of text.
std::string summaryText(const planner::Route& route);

/// Joules as J, kJ or MJ, four digits.
std::string energyText(double joules);

/// "2 h 05 min", "45 s", "3 d 04 h".
std::string durationText(double seconds);

}  // namespace talus::cli
