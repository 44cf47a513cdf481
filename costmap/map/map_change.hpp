#pragma once

#include <atomic>
#include <stdexcept>
#include <string>

namespace talus::costmap {

/// Guard of a call that changes a map: a concurrent change throws an error instead of causing a data race.
class MapChange {
 public:
  /// Marks the map as changing during the lifetime of the object. Throws std::logic_error, which names the
  /// function `call`, if another thread is changing the map.
  MapChange(std::atomic_flag& changing, const char* call) : changing_(changing) {
    if (changing_.test_and_set(std::memory_order_acquire))
      throw std::logic_error(std::string("TraversabilityMap: ") + call +
                             "() while another thread changes the map; let one thread change it");
  }
  MapChange(const MapChange&) = delete;
  MapChange& operator=(const MapChange&) = delete;
  ~MapChange() { changing_.clear(std::memory_order_release); }

 private:
  std::atomic_flag& changing_;
};

}  // namespace talus::costmap
