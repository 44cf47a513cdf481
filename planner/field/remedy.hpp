#pragma once

#include <functional>
#include <string>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Information about the cells around an invalid start or goal.
struct PlaceDiagnostics {
  HazardsOf hazards{};                       ///< hazards of blocked cells; empty if not known
  std::function<bool(maps::Cell)> joined{};  ///< whether a cell is connected to the other end; empty if not
                                             ///< known
};

/// One-line message for an invalid start or goal: the reason, and the nearest traversable cell, preferably a
/// cell that is connected to the other end. `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place,
                         const PlaceDiagnostics& help = {});

/// Returns true if some heading is allowed at the place, or at a cell centre within the tolerance >= 0 [m].
bool mayEnd(const MotionCost& cost, maps::Point place, double tolerance_m);

}  // namespace talus::planner
