#pragma once

#include <memory>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/refine/any_angle.hpp>
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

/// Planner for a map of which only the tiles near a guide are in memory: the grid route in a tube (area of
/// limited width) around the guide, refined to arbitrary headings. The route may differ from that of
/// FieldPlanner if the guide does not follow the best corridor. Deterministic for any number of threads. Not
/// thread-safe.
class TubePlanner {
 public:
  TubePlanner();

  /// Returns the guide for `leg`: the route from start to goal on the coarse map `coarse`. Empty if the
  /// coarse map has no traversable cell near start or goal, or no route between both.
  Polyline guideOver(const std::shared_ptr<const costmap::CostGrid>& coarse, const Problem& leg);

  /// Returns a plan near the given guide; its lower bound is that of the straight line. Returns NoneFound if
  /// the tube around the guide contains no route.
  Plan planAlong(const Problem& problem, const Polyline& guide);

 private:
  Plan finished(const Problem& leg, Polyline way, const StopCheck& stop);

  FieldPlanner coarse_;
  Refiner refine_;
};

/// Plans a route on a map that does not fit in memory. The route on the overview is the guide, and each leg
/// is planned on the tiles near the guide. Replaces problem.map by the map of the last leg.
Plan planInWindows(Problem& problem, WindowedMap& map);

}  // namespace talus::planner
