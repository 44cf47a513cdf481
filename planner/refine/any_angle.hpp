#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/planner/refine/point_search.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Cache of refined windows (sections) of routes, so that an identical window on unchanged ground is not
/// refined again. Results used in the last two rounds remain; a round is the refinement of one route.
/// Thread-safe except for newRound(), forget() and clear().
class RefinementCache {
 public:
  /// Returns the stored result for a window; empty if there is none.
  std::optional<Polyline> find(const Polyline& window);

  /// Stores the result for a window. The result depends on the ground within `reach_m` of the bounding box of
  /// the window.
  void keep(const Polyline& window, const Polyline& result, double reach_m);

  /// Removes results that depend on the ground in the rectangle with the opposite corners `corners`.
  void forget(const Segment& corners);

  void clear() { known_.clear(); }

  /// Begins the refinement of another route: removes entries that were not used since the previous call.
  void newRound();

 private:
  struct Hash {
    std::size_t operator()(const Polyline& window) const noexcept;
  };
  struct Entry {
    Polyline result;
    maps::Point low, high;  // bounding box of the ground that the result depends on
    std::uint64_t round;    // round of the latest use
  };

  std::mutex mutex_;
  std::unordered_map<Polyline, Entry, Hash> known_;
  std::uint64_t round_ = 0;
};

/// Parameters of the refinement.
struct RefineOptions {
  /// Largest distance of the refined route from the given route [cells]: from its cells that permit every
  /// heading, and from its other cells.
  int reach_cells = 4, detour_cells = 24;
  int points_per_side = 3;  ///< number of points per cell side at which the route may cross it
  int slides = 12;          ///< number of rounds in which turns are moved along cell edges
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
  Polyline refinedStretch(const MotionCost& cost, const PointSearch& search, Polyline stretch,
                          const StopCheck& stop) const;
  Polyline acrossEdges(const MotionCost& cost, const PointSearch& search, const Polyline& window) const;

  RefineOptions options_;
  RefinementCache memo_;
};

}  // namespace talus::planner
