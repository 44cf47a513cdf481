#pragma once

#include <functional>
#include <string>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Information about the cells around an invalid start or goal, for the error message.
struct PlaceDiagnostics {
  HazardsOf hazards{};  ///< hazard of a cell without allowed heading; empty if not known
  /// Returns true if a route connects a cell with the other end (goal or start); empty if not known.
  std::function<bool(maps::Cell)> joined{};
};

/// Returns one line of text for an invalid start or goal at `place`: the reason, and the nearest traversable
/// cell, if possible a cell that is connected with the other end of the route. `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place,
                         const PlaceDiagnostics& help = {});

/// Returns true if a route may end near `place`: some heading is allowed at the place itself, or at a cell
/// centre within the tolerance `tolerance_m` >= 0 of the place.
bool mayEnd(const MotionCost& cost, maps::Point place, double tolerance_m);

}  // namespace talus::planner
