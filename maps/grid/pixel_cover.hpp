#pragma once

#include <array>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Rasterises quadrilateral pixels: each cell gets the maximum of all pixels that overlap it, for any size,
/// angle and shape of the pixels. A cell and a pixel overlap unless a side of either separates them
/// (separating axes of convex polygons). An overlap below 0.001 cells is ignored, so that rounding does not
/// extend a pixel into the neighbouring cell.
class PixelCover {
 public:
  explicit PixelCover(const Grid& grid);

  /// Adds a pixel, given by its corners in order [m] from the south-west corner of the grid. Ignores a pixel
  /// with a NaN value or a non-finite corner.
  void add(const std::array<Point, 4>& corners, float value);

  /// Returns the maximum of each cell; NaN for cells without a pixel.
  Raster<float>& values() noexcept { return values_; }

 private:
  Raster<float> values_;
};

}  // namespace talus::maps
