#pragma once

#include <memory>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/tube_search.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans on large maps from coarse to fine: a route on the pooled map, the grid route in a tube around it,
/// and any-angle refinement. If the tube contains no route, the whole field is settled, so NoRoute is
/// reliable. Needs one byte per cell for the pooled map plus the boxes of a few tubes, while FieldPlanner
/// needs twenty bytes per cell. The route may differ from FieldPlanner's if the best corridor is not visible
/// on the pooled map.
///
/// The pooled map is cached, and a newer version is pooled only where the map changed. Deterministic for any
/// number of threads. Not thread-safe.
class TubePlanner {
 public:
  explicit TubePlanner(const TubeOptions& tube = {}, const RefineOptions& refine = {})
      : options_(tube), coarse_(roughly()), refine_(refine) {}

  /// Returns the plan as FieldPlanner::plan() does, with a straight-line lower bound of the cost. Throws
  /// std::invalid_argument if the problem has no map.
  Plan plan(const Problem& problem);

  /// Guide from start to goal: the route on a coarse map. Empty if the coarse map has no traversable cell
  /// near both ends or no route between them.
  Polyline guideOver(const std::shared_ptr<const costmap::CostGrid>& coarse, const Problem& leg);

  /// Plans near a known guide, for example a guide from an overview of a map that does not fit in memory.
  /// Returns NoneFound if the tube contains no route.
  Plan planAlong(const Problem& problem, const Polyline& guide);

  /// Number of cells along each side of a pooled cell.
  static constexpr int kFactor = 8;

 private:
  static RefineOptions roughly();
  Plan planLeg(const Problem& leg, const StopCheck& stop);
  Plan finished(const Problem& leg, Polyline way, const StopCheck& stop);
  bool pool(const Problem& problem, const StopCheck& stop);

  TubeOptions options_;
  FieldPlanner coarse_, whole_;
  Refiner refine_;
  std::shared_ptr<const costmap::CostGrid> map_, pooled_;
};

}  // namespace talus::planner
