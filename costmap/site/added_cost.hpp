#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Sum of the external costs per metre (CostLayer) in each cell, quantised so that similar cells share one cost
/// curve. The sum is rounded up by at most a fifth, to two digits out of 10, 11, 12, 13, 15, 16, 18, 20, 22,
/// 25, 28, 30, 35, 40, 45, 50, 60, 70, 80, 90; positive sums below 0.1 J/m are raised to 0.1 J/m. Steps are
/// equal on all maps, so that a cost in one cell never lowers the cost of another. Infinite costs are
/// omitted, because their cells have Hazard::KeepOut. Immutable.
class AddedCost {
 public:
  explicit AddedCost(const std::vector<CostLayer>& layers);

  /// Returns the step (quantised cost) of a cell; 0: no added cost.
  int step(maps::Cell cell) const { return steps_.empty() ? 0 : steps_[cell]; }
  /// Returns the added cost of a step [J/m], which increases with the step.
  static double J_per_m(int step) noexcept;

 private:
  maps::Raster<std::uint8_t> steps_;
};

}  // namespace talus::costmap
