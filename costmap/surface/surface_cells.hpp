#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <octomap/OcTreeKey.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Octree keys of the cells of a map. The keys x and y are cell indices from the centre of the grid; the key
/// z is the height above a base elevation in units of the cell size. Tree coordinates are map coordinates
/// minus origin().
class SurfaceKeys {
 public:
  /// Makes the keys of a grid; base_elevation_m [m] is the elevation of z = 0 in tree coordinates. Throws
  /// std::invalid_argument for more than 65536 cells on a side, the limit of OctoMap's keys.
  SurfaceKeys(const maps::Grid& grid, double base_elevation_m);

  /// Returns the key of a cell at an elevation [m]; elevations outside the tree are clamped.
  octomap::OcTreeKey key(maps::Cell cell, double elevation_m) const noexcept;

  double baseElevation_m() const noexcept { return base_elevation_m_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the map coordinates of the tree's origin.
  maps::Point origin() const noexcept;

 private:
  maps::Grid grid_;
  double base_elevation_m_;
};

/// Lowest and highest height key of the surface over square blocks of cells with sides 1, 2, 4, ... cells (a
/// pyramid), for finding the octree cubes through which the surface passes.
class SurfacePyramid {
 public:
  /// Lowest and highest height key of a block; low > high for a block without elevations.
  struct Range {
    std::uint16_t low = 0xffff;
    std::uint16_t high = 0;
    bool empty() const noexcept { return low > high; }
    /// Returns true if the range overlaps the height keys from `from` to from + count - 1.
    bool meets(unsigned from, unsigned count) const noexcept { return low < from + count && high >= from; }
  };

  SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys);

  /// Returns the range of the block of 2^level cells per side that starts at these keys, which are multiples
  /// of 2^level.
  Range range(unsigned level, unsigned x_key, unsigned y_key) const noexcept;

 private:
  struct Level {
    unsigned first_x, first_y, width, height;
    std::vector<Range> ranges;
  };
  std::vector<Level> levels_;
};

}  // namespace talus::costmap
