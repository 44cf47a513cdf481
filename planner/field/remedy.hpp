#pragma once

#include <string>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// One line for a place that no route may begin or end at: why, and the nearest place that will do.
/// `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place);

/// Whether some heading may be driven at the place, or within the tolerance, >= 0, of it.
bool mayEnd(const MotionCost& cost, maps::Point place, double tolerance_m);

}  // namespace talus::planner
