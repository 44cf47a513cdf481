#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// What all cost layers of a map add to a metre in each cell, in steps, since a cell's cost is one of 254 curves: their
/// sum, rounded up by at most a fifth to two digits out of 10, 11, 12, 13, 15, 16, 18, 20, 22, 25, 28, 30, 35, 40, 45, 50,
/// 60, 70, 80, 90; less than 0.1 J counts as that. The steps are the same on every map, so that what is added in one
/// place lowers nothing in another. Infinite adds nothing here: such a cell is refused by its hazard. Immutable.
class AddedCost {
 public:
  static constexpr int kCoarsest = 3;  ///< highest level

  explicit AddedCost(const std::vector<CostLayer>& layers);

  bool empty() const noexcept { return steps_.empty(); }

  /// Of a cell; 0: nothing is added. At levels 1, 2 and 3 only each 2nd, 8th and 32nd step is used: a step
  /// is needed once for each kind of ground, and a cell whose cost has no curve left is refused.
  int step(maps::Cell cell, int level = 0) const {
    const int many = level == 0 ? 1 : 1 << (2 * level - 1);
    return steps_.empty() ? 0 : (steps_[cell] + many - 1) / many * many;
  }
  /// Joules that a step adds to a metre; grows with the step.
  static double J_per_m(int step) noexcept;

 private:
  maps::Raster<std::uint8_t> steps_;
};

}  // namespace talus::costmap
