#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::costmap {

/// Returns the cost map with other cost weights. The result shares the tiles (blocks of 64x64 cells) of `map`
/// and refuses the same motions. Throws std::domain_error if a cost curve of the map has no
/// GroundCost::states, and std::invalid_argument for a negative weight.
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights);

}  // namespace talus::costmap
