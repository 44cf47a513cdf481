#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <octomap/OcTreeKey.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Where a map's cells lie in an octree: keys count cells from the grid's middle, heights from a base
/// elevation, all in the map's resolution. Tree coordinates are map metres less origin().
class SurfaceKeys {
 public:
  /// Throws std::invalid_argument when the grid has more than 65536 cells on a side, the most that OctoMap
  /// addresses.
  SurfaceKeys(const maps::Grid& grid, double base_elevation_m);

  /// The key of the cell at an elevation [m]; heights beyond the tree are clamped into it.
  octomap::OcTreeKey key(maps::Cell cell, double elevation_m) const noexcept;

  /// The middle of a voxel with this height key [m].
  double heightOf_m(octomap::key_type height) const noexcept;

  double baseElevation_m() const noexcept { return base_elevation_m_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  /// Map metres of the tree's (0, 0).
  maps::Point origin() const noexcept;

 private:
  maps::Grid grid_;
  double base_elevation_m_;
};

/// Highest and lowest key under each power-of-two block of cells: tells which cubes the surface passes
/// through.
class SurfacePyramid {
 public:
  /// Lowest and highest height key of a block; empty (low > high) where no cell has an elevation.
  struct Range {
    std::uint16_t low = 0xffff;
    std::uint16_t high = 0;
    bool empty() const noexcept { return low > high; }
    bool meets(unsigned from, unsigned count) const noexcept { return low < from + count && high >= from; }
  };

  SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys);

  /// Range of the block of 2^level cells a side that starts at these keys (multiples of 2^level).
  Range range(unsigned level, unsigned x_key, unsigned y_key) const noexcept;

 private:
  struct Level {
    unsigned first_x, first_y, width, height;
    std::vector<Range> ranges;
  };
  std::vector<Level> levels_;
};

}  // namespace talus::costmap
