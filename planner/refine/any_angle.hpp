#pragma once

#include <vector>

#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/route_windows.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Parameters of the refinement.
struct RefineOptions {
  CorridorOptions corridor{};  ///< search over points of cell edges near the route
  int slides = 12;             ///< number of rounds in which turns are moved along cell edges
};

/// Refinement of routes to fewer and better turns. The result never costs more than the given route, has the
/// same first and last point, and consists of allowed motions only.
///
/// The cheapest path over points of the cell edges near the route is computed, and its turns are moved along the
/// edges; then turns that do not pay are left out. Each step uses exact costs (MotionCost). The sections between marks
/// on the route (cutAtMarks) are refined separately, on several threads. Results are kept for each section and
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

}  // namespace talus::planner
