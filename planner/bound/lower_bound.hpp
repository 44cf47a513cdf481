#pragma once

#include <limits>
#include <memory>
#include <optional>

#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// What no route to a goal costs less than, whatever its shape and headings: what a SubSolution proves on maps of up to kSmall cells,
/// the field over admissibleEdges() on larger ones, kept for a map and a goal, or straightBoundOver_J() where that is higher.
class LowerBound {
 public:
  /// Joules, >= 0 and no more than the cost of a known route; the straight bound alone when stopped, or where it shows
  /// that the known route is the best within kEven.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity());

  /// Near the cheapest way in all headings, from the search for the last bound; to be refined. Empty where there was none.
  const Polyline& way() const noexcept { return way_; }

  static constexpr double kEven = 1e-4;
  static constexpr std::size_t kSmall = 250'000;  ///< cells: some 15 microseconds each

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
