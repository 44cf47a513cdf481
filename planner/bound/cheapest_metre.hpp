#pragma once

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// Lowest drive cost per metre [J/m] over all curves that occur on the map and all gradients. Returns 0 if no
/// cell has a curve. Only row 0 of each curve (no gradient across) is read: no other row has a lower cost.
double cheapestMetre_J(const costmap::CostGrid& map);

}  // namespace talus::planner
