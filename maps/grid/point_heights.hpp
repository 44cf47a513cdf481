#pragma once

#include <cstddef>
#include <span>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A point of a point cloud, in the map frame: x east, y north, z up.
struct CloudPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// Rule for the height of a cell from the heights of the cloud points in the cell.
struct HeightChoice {
  /// Percentile of the heights that becomes the height of the cell, (0, 1], rounded up to the height of a
  /// point. 1 selects the highest point.
  double percentile = 1.0;
  /// Least number of points per cell, >= 1; cells with fewer points are unobserved (NaN).
  std::size_t least_points = 1;
};

/// Returns the heights [m] of the cells of a grid from a point cloud; NaN for cells with fewer than
/// choice.least_points points. The result can be used as SurfacePatch::elevation_m. Points outside the grid
/// and non-finite points are ignored; the order of the points has no effect. A percentile below 1 removes
/// outliers above the ground, but also removes the tops of narrow steps. Throws std::invalid_argument for an
/// option out of range, and if no cell has enough points.
Raster<float> heightsOf(std::span<const CloudPoint> points, const Grid& grid,
                        const HeightChoice& choice = {});

}  // namespace talus::maps
