#pragma once

#include <array>
#include <vector>

#include <talus/planner/bound/cost_lower_bound.hpp>
#include <talus/planner/field/edge_units.hpp>

namespace talus::planner {

/// Lower bounds w_k of the cost of a metre along the eight headings e_k of the grid. The gauge, a function of
/// direction that has the values w_k at e_k and is linear between neighbouring headings, is at most the cost
/// per metre of the cell: a metre along p e_k + q e_(k+1), p, q >= 0, costs at least p w_k + q w_(k+1). The
/// bound is higher than a CostLowerBound, because each heading has its own part of the cost curve.
///
/// Derivation (ours, not from the literature). The cost of a metre is H(s) + tilt * s, where s is the
/// gradient of the ground along the direction. The second term is linear in the direction; therefore the
/// gauge reproduces it exactly. Directions are divided into sub-sectors of 45/8 degrees, gradients into
/// squares of kSteps steps of CellCode. Over one sub-sector and one square, s stays in an interval, and the
/// gradient across the direction is at least some c. Costs never decrease from row to row (TravelCurve);
/// therefore H is at least its minimum over the bins of that interval in the row of c. Within a sub-sector, p
/// w_k + q w_(k+1) is a sine of the angle and exceeds the larger of its end values by a factor of at most 1 /
/// cos(half a sub-sector). Therefore the gauge is below H if its values at both ends of every sub-sector are
/// below cos(half a sub-sector) times that minimum. At first the w_k of all headings are equal; each round
/// increases each w_k by half of the increase that its directions and neighbours permit.
///
/// Squares are computed at first use. Not thread-safe. The TravelCost must outlive the object.
class DirectionalLowerBounds {
 public:
  using DirectionCosts = std::array<float, 8>;  ///< lower bounds [J/m], > 0, indexed by GridHeading

  explicit DirectionalLowerBounds(const costmap::TravelCost& cost);

  /// Returns the lower bounds along the eight headings for a cell that has a cost curve; infinite if the cell
  /// allows no heading.
  DirectionCosts of(costmap::CellCode cell);

 private:
  static constexpr int kParts = 8;    // number of sub-sectors between two neighbouring headings
  static constexpr int kSteps = 16;   // side of a square of gradients [steps of CellCode]
  static constexpr int kReach = 512;  // largest gradient [steps]; steeper cells use CostLowerBounds

  struct Square {
    bool known = false;
    DirectionCosts own{};  // lower bounds without the term of the tilt
    double tilt_J_per_m = 0.0;
  };

  Square squareOf(std::size_t curve, double dz_dx, double dz_dy) const;
  Square squareWith(std::size_t curve, double dz_dx, double dz_dy, double tilt_J_per_m) const;
  DirectionCosts steep(costmap::CellCode cell) const;

  const costmap::TravelCost& cost_;
  CostLowerBounds lines_;
  std::vector<std::vector<Square>> squares_;  // by cost curve
};

}  // namespace talus::planner
