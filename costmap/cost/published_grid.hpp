#pragma once

#include <memory>
#include <mutex>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::costmap {

/// Holder of the current version of the cost grid; a new version replaces the current one as a whole. load()
/// is thread-safe. The class uses a mutex because std::atomic<std::shared_ptr> of GCC 12 unlocks without
/// memory ordering: on a weakly ordered processor, a reader could combine one grid with the reference count
/// of another.
class PublishedGrid {
 public:
  std::shared_ptr<const CostGrid> load() const {
    const std::lock_guard lock(mutex_);
    return grid_;
  }
  void store(std::shared_ptr<const CostGrid> next) {
    const std::lock_guard lock(mutex_);
    grid_.swap(next);  // the previous version is destroyed after the unlock
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const CostGrid> grid_;
};

}  // namespace talus::costmap
