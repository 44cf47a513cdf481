#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// What work on windows of a route gave, by the window: the same window on the same ground need not be worked
/// on twice. Results of the last two rounds are kept. Safe to share between threads, but for newRound() and
/// forget().
class RefinementCache {
 public:
  std::optional<Polyline> find(const Polyline& window);

  /// Remembers a result that depends on the ground within reach_m of the window's bounding box.
  void keep(const Polyline& window, const Polyline& result, double reach_m);

  /// Forgets what depends on the ground between two opposite corners.
  void forget(const Segment& corners);

  void clear() { known_.clear(); }

  /// A new route begins: entries not used since the last call are dropped.
  void newRound();

 private:
  struct Hash {
    std::size_t operator()(const Polyline& window) const noexcept;
  };
  struct Entry {
    Polyline result;
    maps::Point low, high;  // ground that it depends on
    std::uint64_t round;    // in which it was used last
  };

  std::mutex mutex_;
  std::unordered_map<Polyline, Entry, Hash> known_;
  std::uint64_t round_ = 0;
};

}  // namespace talus::planner
