#pragma once

#include <memory>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Parameters of tubeRoute(). Distances are in cells.
struct TubeOptions {
  double margin_cells = 48.0;   ///< initial distance from the guide to the border of the tube
  double leg_cells = 384.0;     ///< length of the legs of the guide that are searched separately
  double overlap_cells = 96.0;  ///< length, on both sides of a joint of two legs, that is searched again
  /// Number of times that the margin of a leg is doubled if its route touches the border of the tube.
  int widenings = 3;
};

/// Returns a grid route from start to goal near `guide`. The guide is divided into legs. Each leg is searched
/// with the cost-to-go field of a box of tiles (64 x 64 cells) around the leg, without the tiles outside the
/// tube (area within the margin of the guide). If the route of a leg touches the border of the tube, the leg
/// is searched again in a wider tube. A leg without a route is joined with the next leg (the last leg with
/// the previous leg). The boxes of only a few legs are in memory at a time. The result is empty after a stop,
/// or if no route was found, which is no proof that there is none. The guide leads from the start of the
/// problem to its goal; its motions need not be allowed. Via points are ignored.
Polyline tubeRoute(const Problem& problem, const Polyline& guide, const TubeOptions& options = {},
                   const StopCheck& stop = {});

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
