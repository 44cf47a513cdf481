#pragma once

#include <memory>
#include <mutex>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::costmap {

/// The version that readers see, replaced as a whole. Any thread may call load() at any time. A mutex, since the
/// std::atomic<std::shared_ptr> of GCC 12 unlocks without ordering: on a processor that reorders, a reader could pair one
/// grid with the reference count of another.
class PublishedGrid {
 public:
  std::shared_ptr<const CostGrid> load() const {
    const std::lock_guard lock(mutex_);
    return grid_;
  }
  void store(std::shared_ptr<const CostGrid> next) {
    const std::lock_guard lock(mutex_);
    grid_.swap(next);  // the version before is freed after the lock
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const CostGrid> grid_;
};

}  // namespace talus::costmap
