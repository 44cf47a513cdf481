#pragma once

#include <array>
#include <vector>

#include <talus/planner/bound/cost_lower_bound.hpp>
#include <talus/planner/field/edge_units.hpp>

namespace talus::planner {

/// Lower bounds of the cost of a metre along the eight grid headings. The gauge with the values w_k at the
/// headings e_k, linear between neighbouring headings, is nowhere above the drive cost of the cell: a metre
/// along p e_k + q e_(k+1), p, q >= 0, costs at least p w_k + q w_(k+1). The bound is tighter than a
/// CostLowerBound, because each heading has its own section of the curve.
///
/// Derivation (ours, not from the literature). The cost of a metre is H(s) + tilt * s, with s the gradient
/// along the direction. The second term is linear in the direction, so the gauge reproduces it exactly.
/// Directions are divided into sub-sectors of 45/8 degrees, gradients into squares of kSteps steps of
/// CellCode. Over one sub-sector and one square, s stays in an interval and the gradient across is at least
/// some c. Costs never decrease from row to row (TravelCurve), so H is at least its minimum over the bins of
/// that interval in the row of c. Within a sub-sector, p w_k + q w_(k+1) is a sine of the angle and exceeds
/// the larger of its end values by a factor of at most 1 / cos(half a sub-sector). The gauge is therefore
/// below H if both ends of every sub-sector are below cos(half a sub-sector) times that minimum. The costs
/// start equal for all headings; each round raises each cost by half of the increase that its directions and
/// neighbours allow.
///
/// Squares are computed at first use. Not thread-safe. The TravelCost must outlive the object.
class DirectionalLowerBounds {
 public:
  using DirectionCosts = std::array<float, 8>;  ///< joules per metre, > 0, by GridHeading

  explicit DirectionalLowerBounds(const costmap::TravelCost& cost);

  /// Returns the lower bounds of a cell with a drive curve along the eight headings; infinite if no heading
  /// is allowed.
  DirectionCosts of(costmap::CellCode cell);

 private:
  static constexpr int kParts = 8;    // sub-sectors of the 45 degrees between two headings
  static constexpr int kSteps = 16;   // side of a square [steps]
  static constexpr int kReach = 512;  // [steps]; steeper cells use CostLowerBounds

  struct Square {
    bool known = false;
    DirectionCosts own{};  // without the term of the tilt
    double tilt_J_per_m = 0.0;
  };

  Square squareOf(std::size_t curve, double dz_dx, double dz_dy) const;
  Square squareWith(std::size_t curve, double dz_dx, double dz_dy, double tilt_J_per_m) const;
  DirectionCosts steep(costmap::CellCode cell) const;

  const costmap::TravelCost& cost_;
  CostLowerBounds lines_;
  std::vector<std::vector<Square>> squares_;  // by curve
};

}  // namespace talus::planner
