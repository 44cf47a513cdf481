#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

/// The sides of a cell.
enum CellSide : int { kWestSide, kEastSide, kSouthSide, kNorthSide };

/// A point of a cell's edge, in cells from the cell's south-west corner.
struct EdgeSpot {
  double x = 0.0;
  double y = 0.0;
};

/// The point number k of `points` on a side.
EdgeSpot edgeSpot(int side, int k, int points) noexcept;

/// All straight motions across a cell from a point of its edge to the points of the other three sides, and
/// what they cost: DriveCost in the heading of each, in joules for cells of a metre. It points into the
/// DriveCost, which must outlive it. Immutable.
class EdgeCrossings {
 public:
  /// Where a motion ends.
  struct End {
    int side;
    int k;
  };

  EdgeCrossings(const costmap::DriveCost& cost, int points, Kernels kernels = Kernels::Best);

  /// Points of a side.
  int points() const noexcept { return points_; }

  /// Motions from one point.
  int count() const noexcept { return 3 * points_; }

  /// Where the motions from a point of a side end, in the order of prices().
  const End* ends(int side, int k) const noexcept { return &ends_[first(side, k)]; }

  /// What is paid after each motion from a point of a side, `here` having been paid before; infinite where
  /// the heading may not enter. Room for count() rounded up to whole vectors of kVector.
  void prices(int side, int k, costmap::CellCode cell, float here, float* paid) const noexcept;

  static constexpr int kVector = 4;

  /// Whether a cell may be entered in the heading of motion number i from a point of a side.
  bool allowed(int side, int k, int i, costmap::CellCode cell) const noexcept;

  /// Whether a cell may be entered in any heading.
  bool free(costmap::CellCode cell) const noexcept;

 private:
  std::size_t first(int side, int k) const noexcept {
    return static_cast<std::size_t>((side * points_ + k) * padded_);
  }

  const costmap::DriveCost& cost_;
  int points_;
  int padded_;  // count() in whole vectors
  bool vectors_;
  std::vector<End> ends_;
  std::vector<double> x_, y_;  // headings times the gradient step
  std::vector<float> length_;
  std::vector<double> free_up_to_;  // by curve: gradients no steeper are allowed in every heading
};

}  // namespace talus::planner
