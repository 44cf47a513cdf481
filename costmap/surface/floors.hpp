#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace talus::costmap {

/// A level of a point cloud as map files of earlier programs list it in the section FLOR.
struct Floor {
  std::uint32_t cell = 0;  ///< index of the cell in the map's grid
  float height_m = 0.0F;   ///< elevation of the level
};

/// The section FLOR of a map file: always empty, because a map has one surface.
class Floors {
 public:
  Floors() = default;
  /// Throws std::invalid_argument for a map with levels.
  Floors(const std::vector<Floor>& floors, std::size_t /*cells*/) {
    if (!floors.empty()) throw std::invalid_argument("it has levels of a point cloud; build it again");
  }

  std::vector<Floor> all() const { return {}; }
};

}  // namespace talus::costmap
