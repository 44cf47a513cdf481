#pragma once

#include <memory>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/tube_search.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans on large maps from coarse to fine: a route on the pooled map, the grid route in a tube around it,
/// any-angle refinement. Where the tube holds no way the whole field is settled, so that no route means no
/// route. Takes a byte a cell of pooled map and a few tubes' boxes, where FieldPlanner takes twenty bytes a
/// cell; routes may differ from its routes by the ways that are not seen on the pooled map.
///
/// The pooled map is kept, and a newer version pooled only where it changed. Deterministic for any
/// number of threads. Not thread-safe.
class TubePlanner {
 public:
  explicit TubePlanner(const TubeOptions& tube = {}, const RefineOptions& refine = {})
      : options_(tube), coarse_(roughly()), refine_(refine) {}

  /// As FieldPlanner::plan; the lower bound is the simple one. Throws std::invalid_argument without a map.
  Plan plan(const Problem& problem);

  /// A way from start to goal by the route on a coarse map, to plan along; empty when that has none near
  /// both.
  Polyline guideOver(const std::shared_ptr<const costmap::CostGrid>& coarse, const Problem& leg);

  /// The route near a guide that is known already, as from an overview of a map that memory does not hold as
  /// a whole; NoneFound where the tube holds none.
  Plan planAlong(const Problem& problem, const Polyline& guide);

  /// Cells to a side of a pooled cell.
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
