#pragma once

#include <vector>

#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/refine/short_cut.hpp>
#include <talus/planner/refine/station_shift.hpp>

namespace talus::planner {

/// How hard a route is refined. Distances in cells.
struct RefineOptions {
  double short_cut_cells = 8.0;  ///< how far apart the ends of short cuts lie along the route
  double coarsest_cells = 16.0;  ///< of the first stations along the route; halves from round to round
  double finest_cells = 8.0;     ///< the last
  ShiftOptions shift{};          ///< places beside the stations
  CorridorOptions corridor{};    ///< search over cell edges beside what the stations found
  int slides = 12;               ///< rounds of moving turns along cell edges
};

/// Makes routes of fewer, better turns: never more expensive than the given one, the first and last points
/// kept, every motion allowed.
///
/// First the parts that a straight motion does cheaper are cut short. Then, from coarse to fine, places
/// beside stations are chosen; then the cheapest way over points of the cells' edges near the route is
/// searched and its turns are slid along those edges. All by dynamic programming, costs exact by MotionCost.
/// After the short cuts the work is done stretch by stretch between marks that the route itself sets
/// (cutAtMarks): on several threads, and only once on the same stretch of the same ground, so a route that
/// changed in part is worked on in part. The answer depends on neither. Ours, not from the literature.
class Refiner {
 public:
  explicit Refiner(const RefineOptions& options = {}) : options_(options) {}

  /// The route given must be allowed. Ends early, with the best so far, at a stop request.
  Polyline operator()(const MotionCost& cost, Polyline route, int threads = 1, const StopCheck& stop = {});

  /// The ground changed between two opposite corners / altogether.
  void forget(const Segment& corners) { memo_.forget(corners); }
  void clear() { memo_.clear(); }

 private:
  Polyline refinedStretch(const MotionCost& cost, const CorridorSearch& search, Polyline stretch,
                          const StopCheck& stop) const;
  Polyline acrossEdges(const MotionCost& cost, const CorridorSearch& search, const Polyline& window) const;

  RefineOptions options_;
  RefinementCache memo_;
};

/// One route, once.
Polyline refined(const MotionCost& cost, Polyline route, const RefineOptions& options = {},
                 const StopCheck& stop = {});

}  // namespace talus::planner
