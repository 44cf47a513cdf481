#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

/// The sides of a cell.
enum CellSide : int { kWestSide, kEastSide, kSouthSide, kNorthSide };

/// A point of a cell's edge, in cells from the cell's south-west corner.
struct EdgeSpot {
  double x = 0.0;
  double y = 0.0;
};

/// Returns the point with index k, 0 to points - 1, of the `points` points on a side.
EdgeSpot edgeSpot(int side, int k, int points) noexcept;

/// All straight motions across a cell from a point of its edge to the points of the other three sides, and
/// their TravelCost by heading, in joules for cells of 1 m. Refers to the TravelCost, which must outlive the
/// object. Immutable.
class EdgeCrossings {
 public:
  /// End point of a motion.
  struct End {
    int side;
    int k;
  };

  EdgeCrossings(const costmap::TravelCost& cost, int points, Kernels kernels = Kernels::Best);

  /// Returns the number of points per side.
  int points() const noexcept { return points_; }

  /// Returns the number of motions from one point.
  int count() const noexcept { return 3 * points_; }

  /// End points of the motions from a point of a side, in the order of prices().
  const End* ends(int side, int k) const noexcept { return &ends_[first(side, k)]; }

  /// Writes to `paid` the cost of each motion from a point of a side plus `here`; infinite if the heading is
  /// not allowed. `paid` needs space for count() values rounded up to a multiple of kVector.
  void prices(int side, int k, costmap::CellCode cell, float here, float* paid) const noexcept;

  static constexpr int kVector = 4;

  /// Returns true if the cell allows the heading of motion i from a point of a side.
  bool allowed(int side, int k, int i, costmap::CellCode cell) const noexcept;

  /// Returns true if the cell allows every heading.
  bool free(costmap::CellCode cell) const noexcept;

 private:
  std::size_t first(int side, int k) const noexcept {
    return static_cast<std::size_t>((side * points_ + k) * padded_);
  }

  const costmap::TravelCost& cost_;
  int points_;
  int padded_;  // count() rounded up to whole vectors
  bool vectors_;
  std::vector<End> ends_;
  std::vector<double> x_, y_;  // headings times the gradient step
  std::vector<float> length_;
  std::vector<double> free_up_to_;  // by curve: steepness up to which every heading is allowed
};

}  // namespace talus::planner
