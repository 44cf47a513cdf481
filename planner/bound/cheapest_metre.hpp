#pragma once

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// Joules of the cheapest metre that any cell of the map offers to any heading; 0 where none is allowed.
/// It is found in the row of a curve without anything across, below which no other row lies.
double cheapestMetre_J(const costmap::CostGrid& map);

}  // namespace talus::planner
