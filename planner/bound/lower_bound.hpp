#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Computes a lower bound of the cost of every route to a goal, of any shape and heading, in levels. Each level
/// is a cost-to-go field over admissibleEdges(), and none lowers the bound.
///
/// Level 1 fits the octagons of all cells alike (FittedOctagons). With F, the field of the start, and B, the
/// field of the goal, every route of at most the known cost K stays in the region of the cells with a corner at
/// which F + B <= K: it crosses the boundary of each cell where the interpolated sum is at most K (ours;
/// compare Clawson, Chacon and Vladimirsky 2014 [clawson_2014]). Level 2 searches the region alone. It fits the
/// octagon of each cell to the differences of near-exact costs from the start (MeshSearch) between its corners,
/// then to those of its own field, which never lowers the field. The bound does not depend on the accuracy of
/// these costs, because every octagon is below the limits of its cell. Level 3 is a SubSolution in the region
/// that F of level 2 leaves. The work of each level is limited, so that the bound costs at most a few times the
/// field; a level that exceeds its limit contributes nothing. straightBoundOver_J(), or the bound on a
/// uniform map that is nowhere more expensive, is used if it is higher.
class LowerBound {
 public:
  /// Returns the lower bound [J] for routes from `places.from` to within `goal_tolerance_m` of `places.to`.
  /// `known_J` is the cost of a known route; the result is between 0 and known_J. If the relative difference
  /// of a bound from known_J is at most kEven, no further level is computed. A level that a stop ended
  /// contributes 0.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity());

  /// Returns the near-optimal route over all headings from the latest search of the region, as initial route of a
  /// refinement; empty if there was none.
  const Polyline& way() const noexcept { return way_; }

  /// Relative difference to the cost of the known route up to which a bound suffices.
  static constexpr double kEven = 1e-4;
  /// Relative difference up to which level 2 suffices.
  static constexpr double kEnough = 0.02;

 private:
  OctagonOf octagonOf();
  void narrow(std::vector<bool>& region, const std::vector<float>& from_start, double known_J) const;
  double narrowed_J(const Segment& places, const std::vector<FieldGoal>& starts, double known_J,
                    const StopCheck& stop);

  std::shared_ptr<const costmap::CostGrid> map_;
  std::optional<FittedOctagons> octagons_;
  std::vector<float> to_goal_;  // field of the goal, level 1
  Polyline way_;
  maps::Point goal_;
  double tolerance_m_ = 0.0;
};

}  // namespace talus::planner
