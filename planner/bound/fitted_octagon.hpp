#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <talus/planner/bound/directional_cost_bounds.hpp>
#include <talus/planner/field/edge_units.hpp>

namespace talus::planner {

/// Weights w_k [J/m] > 0 of the eight headings e_k of the grid, indexed by GridHeading. The gauge, a function
/// of direction that equals w_k at e_k and is linear between neighbouring headings, is convex and at most the
/// cost per metre of a cell. All weights are infinite for a cell that allows no heading.
using Octagon = std::array<float, 8>;

/// Returns an octagon below the limits of a cell that is near `wanted`. A function of position that decreases
/// per metre along each heading e_k by at most wanted_k, and satisfies the limits, also satisfies the octagon.
///
/// Proof of the lower bound (ours, not from the literature). The gauge of the limits is linear between 64
/// headings, eight of which lie in each sector of the octagon, where the gauge of the octagon is linear.
/// Therefore the octagon is below the limits everywhere if it is below them at the 64 headings. The wanted
/// weights are projected onto limits that they exceed, and each is scaled by the worst ratio of its two
/// sectors. Then the weights are raised: all at once by half of the increase that the limits and the neighbours
/// permit, so that two neighbours together stay below a shared limit, then one after the other by all of it.
/// Lowering the weights until sqrt(2) w_k <= w_(k-1) + w_(k+1) makes the gauge convex.
Octagon fittedOctagon(const DirectionalCostBounds::Limits& limits, const Octagon& wanted);

/// Octagons of cells whose costs are wanted equally in all directions, computed at the first use of a cell
/// code or a reflection of it. Not thread-safe.
class FittedOctagons {
 public:
  /// `cost` must outlive the object.
  explicit FittedOctagons(const costmap::TravelCost& cost) : limits_(cost) {}

  /// Returns the octagon of a cell code.
  Octagon of(costmap::CellCode cell);

  /// Returns the limits of the cost function.
  DirectionalCostBounds& limits() noexcept { return limits_; }

  /// Every weight of an octagon is at least this share of the lowest cost per metre of the cell's cost curve.
  static constexpr double kLeastShare = 0.05;

 private:
  Octagon fitted(const DirectionalCostBounds::Limits& limits);

  DirectionalCostBounds limits_;
  std::vector<Octagon> known_;  // by the number of the limits
};

}  // namespace talus::planner
