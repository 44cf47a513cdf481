#pragma once

#include <memory>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/tube_search.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Planner for large maps, from coarse to fine. It computes a route on the pooled map (cells of kFactor x
/// kFactor cells), then the grid route in a tube (area of limited width) around this route, and refines it to
/// arbitrary headings. If the tube contains no route, the whole cost-to-go field is computed; therefore the
/// status NoRoute is reliable. The planner needs one byte per cell for the pooled map plus the boxes of a few
/// tubes, while FieldPlanner needs twenty bytes per cell. The route may differ from that of FieldPlanner if
/// the pooled map does not resolve the best corridor.
///
/// The pooled map is kept; for a newer version of the map, only the changed area is pooled again.
/// Deterministic for any number of threads. Not thread-safe.
class TubePlanner {
 public:
  explicit TubePlanner(const TubeOptions& tube = {}, const RefineOptions& refine = {})
      : options_(tube), coarse_(roughly()), refine_(refine) {}

  /// Returns a plan under the conditions of FieldPlanner::plan(); the lower bound is that of the straight
  /// line. Throws std::invalid_argument if the problem has no map.
  Plan plan(const Problem& problem);

  /// Returns the guide for `leg`: the route from start to goal on the coarse map `coarse`. Empty if the
  /// coarse map has no traversable cell near start or goal, or no route between both.
  Polyline guideOver(const std::shared_ptr<const costmap::CostGrid>& coarse, const Problem& leg);

  /// Plans near the given guide, for example a guide on the overview of a map that does not fit in memory.
  /// Returns NoneFound if the tube around the guide contains no route.
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
