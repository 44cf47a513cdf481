#pragma once

#include <vector>

#include <maps/grid.hpp>
#include <planner/motion_cost.hpp>
#include <planner/stop_check.hpp>

namespace talus::planner {

/// How hard a route is refined.
struct RefineOptions {
  double coarsest_cells =
      64.0;                   ///< distance of the first stations along the route; halves from round to round
  double finest_cells = 0.5;  ///< the last
  int candidates = 8;         ///< places to each side of a station, an eighth of the stations' distance apart
  int swing = 3;              ///< most steps sideways from one station to the next
  int repeats = 1;            ///< rounds at each distance
};

/// A route of fewer, better turns: never dearer than the one given, the first and last points kept, every
/// motion allowed.
///
/// First the stretches that a straight motion does cheaper are cut short, by dynamic programming over all
/// pairs of some hundred points. Then, from coarse to fine, stations are set along the route with places to
/// both sides of each, and dynamic programming picks a place at every station; between two stations the
/// present route may be kept, so that no round makes it worse. All costs are exact, by MotionCost. Ours, not
/// from the literature. Ends early, with the best so far, when `stop` says so. The route given must be
/// allowed.
std::vector<maps::Point> refined(const MotionCost& cost, std::vector<maps::Point> route,
                                 const RefineOptions& options = {}, const StopCheck& stop = {});

/// The same route without the points that a straight motion can leave out at no cost.
std::vector<maps::Point> withoutIdleTurns(const MotionCost& cost, const std::vector<maps::Point>& route);

}  // namespace talus::planner
