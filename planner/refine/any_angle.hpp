#pragma once

#include <vector>

#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/refine/short_cut.hpp>
#include <talus/planner/refine/station_shift.hpp>

namespace talus::planner {

/// Parameters of the refinement; distances in cells.
struct RefineOptions {
  double short_cut_cells = 8.0;  ///< spacing of the ends of short cuts along the route
  double coarsest_cells = 16.0;  ///< spacing of the stations in the first round; halved from round to round
  double finest_cells = 8.0;     ///< smallest spacing of the stations
  ShiftOptions shift{};          ///< positions beside the stations
  CorridorOptions corridor{};    ///< search over cell edges near the shifted route
  int slides = 12;               ///< rounds of moving turns along cell edges
};

/// Refines routes to fewer and better turns. The result never costs more than the given route, keeps its
/// first and last point, and consists of allowed motions only.
///
/// First, stretches are replaced by straight motions where cheaper. Then, from coarse to fine, positions
/// beside stations along the route are chosen. Then the cheapest path over points of the cell edges near the
/// route is searched, and its turns are slid along the edges. Each step uses dynamic programming or
/// Dijkstra's algorithm with exact costs (MotionCost). After the short cuts, the stretches between marks on
/// the route (cutAtMarks) are refined separately, on several threads. Results are cached by stretch and
/// ground, so a partly changed route is refined only where it changed. The result depends neither on the
/// threads nor on the cache. Ours, not from the literature.
class Refiner {
 public:
  explicit Refiner(const RefineOptions& options = {}) : options_(options) {}

  /// Refines an allowed route. When stopped, returns the best route so far.
  Polyline operator()(const MotionCost& cost, Polyline route, int threads = 1, const StopCheck& stop = {});

  /// Discards cached results that depend on the ground between two opposite corners.
  void forget(const Segment& corners) { memo_.forget(corners); }
  void clear() { memo_.clear(); }

 private:
  Polyline refinedStretch(const MotionCost& cost, const CorridorSearch& search, Polyline stretch,
                          const StopCheck& stop) const;
  Polyline acrossEdges(const MotionCost& cost, const CorridorSearch& search, const Polyline& window) const;

  RefineOptions options_;
  RefinementCache memo_;
};

/// Refines one route without a cache.
Polyline refined(const MotionCost& cost, Polyline route, const RefineOptions& options = {},
                 const StopCheck& stop = {});

}  // namespace talus::planner
