#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/maps/maps.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::cli {

/// Returns for each vertex of a route the horizontal distance from the start along the route [m].
std::vector<double> distances_m(const planner::Route& route);

/// Returns the share of each category (terramech::Category) of the length of a route [-]; 0 for a route of length 0.
std::array<double, 4> categoryShares(const planner::Route& route);

/// Returns the summary of a route: up to ten quantities with value and unit; unknown quantities are omitted.
/// For a route that was not found, the summary contains status and reason.
std::vector<std::pair<std::string, std::string>> summaryOf(const planner::Route& route);

/// A place where a route is likely to fail, and the remedy.
struct RouteWarning {
  maps::Point place;
  std::string text;
};

/// Returns the place with the least drawbar-pull margin if it is negative, or the riskiest place if immobilisation is
/// more probable than 0.1.
std::optional<RouteWarning> warningOf(const planner::Route& route);

/// Returns one aligned line of text with a quantity and its value.
std::string summaryLine(std::string_view what, std::string_view value);

/// Returns the summary of a route as lines of text.
std::string summaryText(const planner::Route& route);

/// Returns a length as text in m or km.
std::string lengthText(double metres);

/// Returns an energy as text in J, kJ or MJ with four digits.
std::string energyText(double joules);

/// Returns a duration as text: "2 h 05 min", "45 s" or "3 d 04 h".
std::string durationText(double seconds);

}  // namespace talus::cli
