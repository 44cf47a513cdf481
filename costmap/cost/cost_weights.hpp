#pragma once

#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/cost/cross_slope.hpp>

namespace talus::costmap {

/// The same map under other weights; tiles are shared, what is refused stays refused. Throws
/// std::domain_error when the map's cost was made without the numbers behind it (DriveGround::states),
/// std::invalid_argument for a negative weight.
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights);

}  // namespace talus::costmap
