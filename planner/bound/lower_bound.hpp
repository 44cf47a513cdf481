#pragma once

#include <limits>
#include <memory>
#include <optional>

#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Computes a lower bound of the cost of every route to a goal, of any shape and heading. On maps of up to
/// kSmall cells the bound is the larger of the bound of a SubSolution and the bound of a uniform map that is
/// nowhere more expensive. On larger maps the bound is the cost-to-go field over admissibleEdges(), which is
/// kept for one map and goal. If straightBoundOver_J() is higher, this value is used.
class LowerBound {
 public:
  /// Returns the lower bound [J] for routes from `places.from` to within `goal_tolerance_m` of `places.to`.
  /// `known_J` is the cost of a known route; the result is between 0 and known_J. If the relative difference
  /// of the straight-line bound from known_J is at most kEven, the straight-line bound is returned. A
  /// SubSolution or a field that a stop ended contributes 0.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity());

  /// Returns the near-optimal route over all headings from the latest SubSolution, as initial route of a
  /// refinement; empty if no SubSolution was computed.
  const Polyline& way() const noexcept { return way_; }

  /// Relative difference to the cost of the known route up to which the straight-line bound suffices.
  static constexpr double kEven = 1e-4;
  /// Largest number of cells for a SubSolution, which takes about 15 us per cell.
  static constexpr std::size_t kSmall = 250'000;

 private:
  double overEdges_J(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                     double goal_tolerance_m, const StopCheck& stop);

  std::shared_ptr<const costmap::CostGrid> map_;
  std::shared_ptr<const EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  Polyline way_;
  maps::Point goal_;
  double tolerance_m_ = 0.0;
};

}  // namespace talus::planner
