#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

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

}  // namespace talus::planner
