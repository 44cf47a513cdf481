#pragma once

#include <vector>

#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/refine/short_cut.hpp>
#include <talus/planner/refine/station_shift.hpp>

namespace talus::planner {

/// Parameters of the refinement. Distances are in cells. Stations are points at equal spacing along the
/// route.
struct RefineOptions {
  double short_cut_cells = 8.0;  ///< spacing, along the route, of the possible ends of short cuts
  double coarsest_cells = 16.0;  ///< spacing of the stations in the first round, halved in each further round
  double finest_cells = 8.0;     ///< smallest spacing of the stations
  ShiftOptions shift{};          ///< positions on both sides of the stations
  CorridorOptions corridor{};    ///< search over points of cell edges near the shifted route
  int slides = 12;               ///< number of rounds in which turns are moved along cell edges
};

/// Refinement of routes to fewer and better turns. The result never costs more than the given route, has the
/// same first and last point, and consists of allowed motions only.
///
/// First, sections of the route are replaced by straight motions where these are cheaper. Then, from coarse
/// to fine, the stations are moved sideways. Then the cheapest path over points of the cell edges near the
/// route is computed, and its turns are moved along the edges. Each step uses dynamic programming or
/// Dijkstra's algorithm with exact costs (MotionCost). After the short cuts, the sections between marks on
/// the route (cutAtMarks) are refined separately, on several threads. Results are kept for each section and
/// the ground near it; therefore a route that changed in part is refined only there. The result depends
/// neither on the number of threads nor on the kept results. Ours, not from the literature.
class Refiner {
 public:
  explicit Refiner(const RefineOptions& options = {}) : options_(options) {}

  /// Refines a route, which must be allowed. After a stop, returns the best route so far.
  Polyline operator()(const MotionCost& cost, Polyline route, int threads = 1, const StopCheck& stop = {});

  /// Discards kept results that depend on the ground in the rectangle with the opposite corners `corners`.
  void forget(const Segment& corners) { memo_.forget(corners); }
  /// Discards all kept results.
  void clear() { memo_.clear(); }

 private:
  Polyline refinedStretch(const MotionCost& cost, const CorridorSearch& search, Polyline stretch,
                          const StopCheck& stop) const;
  Polyline acrossEdges(const MotionCost& cost, const CorridorSearch& search, const Polyline& window) const;

  RefineOptions options_;
  RefinementCache memo_;
};

/// Refines one route without kept results.
Polyline refined(const MotionCost& cost, Polyline route, const RefineOptions& options = {},
                 const StopCheck& stop = {});

}  // namespace talus::planner
