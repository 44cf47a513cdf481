#pragma once

#include <array>
#include <vector>

#include <talus/planner/bound/cost_lower_bound.hpp>
#include <talus/planner/field/edge_units.hpp>

namespace talus::planner {

/// Prices of a metre along the eight grid headings such that the gauge with these values there, linear
/// between neighbouring headings, is nowhere above the drive cost of a cell: a metre along p e_k + q e_(k+1),
/// p, q >= 0, costs at least p w_k + q w_(k+1). Tighter than a CostLowerBound, since each heading has its own
/// part of the curve.
///
/// How (ours). The cost of a metre is H(s) + tilt * s, s the gradient along it; the second term is linear in
/// the direction, so the gauge repeats it. Directions are taken in eighths of 45 degrees, gradients in
/// squares of kSteps of CellCode's steps. Over the part between two directions and over a square, s stays in
/// a range and the gradient across is at least some c; costs fall from no row to the next (DriveCurve), so H is no
/// less than its least over the bins of that range in the row of c. On a part p w_k + q w_(k+1)
/// is a sine of the angle, so it exceeds the larger of its ends by a factor of 1 / cos(half a part) at most;
/// so it is enough that it stays below cos(half a part) times that least at both ends of every part. From one
/// price for all headings each is raised by half of what its directions and its neighbours leave it, some
/// rounds.
///
/// Squares are computed at their first use. Not thread-safe. The DriveCost must outlive it.
class DirectionalLowerBounds {
 public:
  using Prices = std::array<float, 8>;  ///< joules a metre, > 0, by GridHeading

  explicit DirectionalLowerBounds(const costmap::DriveCost& cost);

  /// Prices for a cell with a drive curve; infinite where no heading is allowed.
  Prices of(costmap::CellCode cell);

 private:
  static constexpr int kParts = 8;    // of the 45 degrees between two headings
  static constexpr int kSteps = 16;   // a square's side
  static constexpr int kReach = 512;  // steps: steeper cells are left to CostLowerBounds

  struct Square {
    bool known = false;
    Prices own{};  // without the tilt's part
    double tilt_J_per_m = 0.0;
  };

  Square squareOf(std::size_t curve, double dz_dx, double dz_dy) const;
  Square squareWith(std::size_t curve, double dz_dx, double dz_dy, double tilt_J_per_m) const;
  Prices steep(costmap::CellCode cell) const;

  const costmap::DriveCost& cost_;
  CostLowerBounds lines_;
  std::vector<std::vector<Square>> squares_;  // by curve
};

}  // namespace talus::planner
