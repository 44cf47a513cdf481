#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/cost/cross_slope.hpp>

namespace talus::costmap {

/// Returns the map with other cost weights; tiles are shared and refusals are unchanged. Throws
/// std::domain_error if the map has a curve without GroundCost::states, std::invalid_argument for a negative
/// weight.
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights);

}  // namespace talus::costmap
