#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Cache of refined windows of a route, so that an identical window on unchanged ground is not refined again.
/// Results of the last two rounds are kept. Thread-safe except for newRound(), forget() and clear().
class RefinementCache {
 public:
  std::optional<Polyline> find(const Polyline& window);

  /// Stores a result that depends on the ground within reach_m of the window's bounding box.
  void keep(const Polyline& window, const Polyline& result, double reach_m);

  /// Removes results that depend on the ground between two opposite corners.
  void forget(const Segment& corners);

  void clear() { known_.clear(); }

  /// Begins a new route: removes entries not used since the previous call.
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
