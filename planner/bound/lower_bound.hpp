#pragma once

#include <limits>
#include <memory>
#include <optional>

#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Lower bound of the cost of every route to a goal, of any shape and heading. Maps of up to kSmall cells use
/// the larger of a SubSolution's bound and the bound of a uniform map; larger maps use the field over
/// admissibleEdges(), which is cached for one map and goal. straightBoundOver_J() is used if higher.
class LowerBound {
 public:
  /// Returns the bound [J], from 0 to known_J. The straight-line bound is returned if it is within a share
  /// kEven of known_J. A stopped SubSolution or field contributes 0.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity());

  /// Near-optimal route over all headings from the latest SubSolution, as a start for refinement. Empty if no
  /// SubSolution was computed.
  const Polyline& way() const noexcept { return way_; }

  static constexpr double kEven = 1e-4;
  static constexpr std::size_t kSmall = 250'000;  ///< largest number of cells for a SubSolution, which takes
                                                  ///< about 15 microseconds a cell

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
