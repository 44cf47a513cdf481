#pragma once

#include <functional>
#include <string>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// What is known of the ground around a place that no route may begin or end at.
struct PlaceHelp {
  HazardsOf hazards{};                       ///< why cells are refused whole; none: they are blocked
  std::function<bool(maps::Cell)> joined{};  ///< whether the other end and a cell are joined; none: not known
};

/// One line for a place that no route may begin or end at: why, and the nearest place that will do, from which the
/// other end can be reached where there is one. `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place,
                         const PlaceHelp& help = {});

/// Whether some heading may be driven at the place, or within the tolerance, >= 0, of it.
bool mayEnd(const MotionCost& cost, maps::Point place, double tolerance_m);

}  // namespace talus::planner
