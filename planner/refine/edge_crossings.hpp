#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

/// The sides of a cell.
enum CellSide : int { kWestSide, kEastSide, kSouthSide, kNorthSide };

/// Point on a side of a cell, in cell side lengths from the south-west corner of the cell.
struct EdgeSpot {
  double x = 0.0;
  double y = 0.0;
};

/// Returns the point with index k of the `points` points on a side, 0 <= k < points.
EdgeSpot edgeSpot(int side, int k, int points) noexcept;

/// Table of all straight motions across a cell from a point of one side to the points of the other three
/// sides, and of their costs by TravelCost for cells of 1 m side length [J]. The TravelCost must outlive the
/// object. Immutable.
class EdgeCrossings {
 public:
  /// End point of a motion: side, and index of the point on this side.
  struct End {
    int side;
    int k;
  };

  EdgeCrossings(const costmap::TravelCost& cost, int points, Kernels kernels = Kernels::Best);

  /// Returns the number of points on each side.
  int points() const noexcept { return points_; }

  /// Returns the number of motions from one point: those to all points of the other three sides.
  int count() const noexcept { return 3 * points_; }

  /// Returns the end points of the motions from point k of a side, in the order of prices().
  const End* ends(int side, int k) const noexcept { return &ends_[first(side, k)]; }

  /// Writes to `paid` the sum of `here` and the cost of each motion from point k of a side across the cell;
  /// infinite if the heading is not allowed. `paid` needs space for count() values rounded up to a multiple
  /// of kVector.
  void prices(int side, int k, costmap::CellCode cell, float here, float* paid) const noexcept;

  static constexpr int kVector = 4;

  /// Returns true if the cell allows the heading of motion i from point k of a side.
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
  std::vector<double> x_, y_;  // unit vectors of the headings times the gradient step
  std::vector<float> length_;
  std::vector<double> free_up_to_;  // by cost curve: gradient up to which every heading is allowed
};

}  // namespace talus::planner
