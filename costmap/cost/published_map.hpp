#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::costmap {

/// The grid that readers see, handed over whole. A mutex, since the std::atomic<std::shared_ptr> of GCC 12 gives its lock
/// back without order: on a processor that reorders, a reader could pair one grid with another's count.
class PublishedGrid {
 public:
  std::shared_ptr<const CostGrid> load() const {
    const std::lock_guard lock(mutex_);
    return grid_;
  }
  void store(std::shared_ptr<const CostGrid> next) {
    const std::lock_guard lock(mutex_);
    grid_.swap(next);  // what was there goes after the lock
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const CostGrid> grid_;
};

/// What readers of a map see, and whether somebody changes it now.
struct PublishedMap {
  PublishedGrid grid;
  std::atomic_flag changing;
};

/// While it lives no other thread changes the map: that is told so instead.
class MapChange {
 public:
  /// Throws std::logic_error naming the call when another thread is changing the map.
  MapChange(PublishedMap& published, const char* call) : published_(published) {
    if (published_.changing.test_and_set(std::memory_order_acquire))
      throw std::logic_error(std::string("TraversabilityMap: ") + call +
                             "() while another thread changes the map; let one thread change it");
  }
  MapChange(const MapChange&) = delete;
  MapChange& operator=(const MapChange&) = delete;
  ~MapChange() { published_.changing.clear(std::memory_order_release); }

 private:
  PublishedMap& published_;
};

}  // namespace talus::costmap
