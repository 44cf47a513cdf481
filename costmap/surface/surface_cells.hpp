#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <octomap/OcTreeKey.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Octree keys of a map's cells: x and y are cell indices from the centre of the grid; z is the height above
/// a base elevation in units of the cell size. Tree coordinates are map coordinates minus origin().
class SurfaceKeys {
 public:
  /// Throws std::invalid_argument for more than 65536 cells on a side, the limit of OctoMap's keys.
  SurfaceKeys(const maps::Grid& grid, double base_elevation_m);

  /// Key of the cell at an elevation [m]; elevations outside the tree are clamped.
  octomap::OcTreeKey key(maps::Cell cell, double elevation_m) const noexcept;

  /// Elevation of the centre of a voxel with this height key [m].
  double heightOf_m(octomap::key_type height) const noexcept;

  double baseElevation_m() const noexcept { return base_elevation_m_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  /// Map coordinates of the tree's origin.
  maps::Point origin() const noexcept;

 private:
  maps::Grid grid_;
  double base_elevation_m_;
};

/// Lowest and highest height key of the surface over each power-of-two block of cells, for finding the cubes
/// through which the surface passes.
class SurfacePyramid {
 public:
  /// Lowest and highest height key of a block; empty (low > high) without elevations.
  struct Range {
    std::uint16_t low = 0xffff;
    std::uint16_t high = 0;
    bool empty() const noexcept { return low > high; }
    bool meets(unsigned from, unsigned count) const noexcept { return low < from + count && high >= from; }
  };

  SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys);

  /// Range of the block of 2^level cells per side that starts at these keys (multiples of 2^level).
  Range range(unsigned level, unsigned x_key, unsigned y_key) const noexcept;

 private:
  struct Level {
    unsigned first_x, first_y, width, height;
    std::vector<Range> ranges;
  };
  std::vector<Level> levels_;
};

}  // namespace talus::costmap
