#pragma once

#include <cstddef>
#include <span>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A point of a point cloud in the map frame.
struct CloudPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// Rule for the height of a cell from its points.
struct HeightChoice {
  double percentile = 1.0;       ///< of the heights, (0, 1], rounded up to a point; 1: the highest point
  std::size_t least_points = 1;  ///< cells with fewer points are unobserved (NaN), >= 1
};

/// Heights [m] on a grid from a point cloud, in the form of SurfacePatch::elevation_m: NaN for cells with
/// fewer than least_points points. Points outside the grid and non-finite points are ignored; the order of
/// the points has no effect. A percentile below 1 removes outliers above the ground, and also the tops of
/// narrow steps. Throws std::invalid_argument for an option out of range, and if no cell has enough points.
Raster<float> heightsOf(std::span<const CloudPoint> points, const Grid& grid,
                        const HeightChoice& choice = {});

}  // namespace talus::maps
