#pragma once

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// Returns the lowest cost per metre [J/m] over all cost curves (kinds of ground, costmap::TravelCurve) that
/// occur on the map and all gradients; 0 if no cell has a cost curve. Only row 0 of each cost curve (no
/// gradient across the heading) is read, because no other row has a lower cost.
double cheapestMetre_J(const costmap::CostGrid& map);

}  // namespace talus::planner
