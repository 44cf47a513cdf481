#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Sum of the external costs per metre (CostLayer) in each cell, quantised because a map has at most 254 cost
/// curves. The sum is rounded up by at most a fifth, to two digits out of 10, 11, 12, 13, 15, 16, 18, 20, 22,
/// 25, 28, 30, 35, 40, 45, 50, 60, 70, 80, 90; positive sums below 0.1 J/m are raised to 0.1 J/m. Steps are
/// equal on all maps, so that a cost in one cell never lowers the cost of another. Infinite costs are
/// omitted, because their cells have Hazard::KeepOut. Immutable.
class AddedCost {
 public:
  static constexpr int kCoarsest = 3;  ///< highest level, i.e. coarseness of the steps

  explicit AddedCost(const std::vector<CostLayer>& layers);

  bool empty() const noexcept { return steps_.empty(); }

  /// Returns the step (quantised cost) of a cell; 0: no added cost. Levels 1, 2 and 3 use only each 2nd, 8th
  /// and 32nd step: each step needs one curve index for each estimate of the ground, and a cell without a
  /// curve index is refused.
  int step(maps::Cell cell, int level = 0) const {
    const int many = level == 0 ? 1 : 1 << (2 * level - 1);
    return steps_.empty() ? 0 : (steps_[cell] + many - 1) / many * many;
  }
  /// Returns the added cost of a step [J/m], which increases with the step.
  static double J_per_m(int step) noexcept;

 private:
  maps::Raster<std::uint8_t> steps_;
};

}  // namespace talus::costmap
