#pragma once

#include <memory>

#include <talus/costmap/cost_grid.hpp>

namespace talus::costmap {

/// What the parts of the one cost function count: cost = energy_J * energy + time_s * time_W + hazard *
/// risk_J.
struct CostWeights {
  double energy = 1.0;  ///< [-], >= 0
  double time_W = 1.0;  ///< joules that one second is worth, >= 0
  double risk_J = 1e7;  ///< joules that the loss of the rover is worth, >= 0
};

/// The same map under other weights; tiles are shared, what is refused stays refused. Throws
/// std::domain_error when the map's cost was made without the numbers behind it (DriveGround::states),
/// std::invalid_argument for a negative weight.
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights);

}  // namespace talus::costmap
