#pragma once

#include <costmap/cost_grid.hpp>
#include <planner/motion_cost.hpp>

namespace talus::planner {

/// No motion of any shape between the two places costs less: their distance at the cheapest metre of any
/// ground.
double lowerBound_J(const costmap::CostGrid& map, const Segment& places);

}  // namespace talus::planner
