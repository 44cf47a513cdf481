#pragma once

#include <talus/costmap/cost_grid.hpp>

namespace talus::planner {

/// Joules of the cheapest metre that any cell of the map offers to any heading; 0 where none is allowed.
double cheapestMetre_J(const costmap::CostGrid& map);

}  // namespace talus::planner
