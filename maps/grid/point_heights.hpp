#pragma once

#include <cstddef>
#include <span>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A point of a cloud in the map's frame.
struct CloudPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// Which height a cell takes from the points above it.
struct HeightChoice {
  double percentile = 1.0;  ///< of its points by height, rounded up to one of them, (0, 1]; 1: the highest
  std::size_t least_points = 1;  ///< fewer leave the cell unobserved, >= 1
};

/// Heights on a grid from a point cloud, as for SurfacePatch::elevation_m: NaN where too few points lie. Points off the
/// grid or that are not finite are left out; their order does not matter. A percentile below 1 leaves out stray points
/// above the ground, and with them the tops of narrow steps. Throws std::invalid_argument for a choice out of range, and
/// where no cell has enough points.
Raster<float> heightsOf(std::span<const CloudPoint> points, const Grid& grid,
                        const HeightChoice& choice = {});

}  // namespace talus::maps
