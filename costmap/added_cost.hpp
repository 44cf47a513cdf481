#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/ground_site.hpp>

namespace talus::costmap {

/// What all cost layers of a map add to a metre in each cell, in steps, since a cell's cost is one of 254 curves: their
/// sum, rounded up by at most a fifth to two digits out of 10, 11, 12, 13, 15, 16, 18, 20, 22, 25, 28, 30, 35, 40, 45, 50,
/// 60, 70, 80, 90; less than 0.1 J counts as that. The steps are the same on every map, so that what is added in one
/// place lowers nothing in another. Infinite adds nothing here: such a cell is refused by its hazard. Immutable.
class AddedCost {
 public:
  explicit AddedCost(const std::vector<CostLayer>& layers);

  /// Of a cell; 0: nothing is added. At a level of GroundKind only each 2^level-th step is used.
  int step(maps::Cell cell, int level = 0) const {
    const int many = 1 << level;
    return steps_.empty() ? 0 : (steps_[cell] + many - 1) / many * many;
  }
  /// Joules that a step adds to a metre; grows with the step.
  static double J_per_m(int step) noexcept;

 private:
  maps::Raster<std::uint8_t> steps_;
};

}  // namespace talus::costmap
