#pragma once

#include <array>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Rasterises quadrilateral pixels, e.g. of a rotated image: each cell of a grid receives the maximum of all
/// pixels that overlap the cell, for any size, angle and shape of the pixels. A cell and a pixel overlap
/// unless a side of the cell or of the pixel separates the two (separating axes of convex polygons). An
/// overlap narrower than 0.001 cells is ignored, so that rounding does not extend a pixel into the
/// neighbouring cell.
class PixelCover {
 public:
  explicit PixelCover(const Grid& grid);

  /// Adds a pixel with the value `value`. The corners are given in order around the pixel, in metres from the
  /// south-west corner of the grid. A pixel with a NaN value or a non-finite corner is ignored.
  void add(const std::array<Point, 4>& corners, float value);

  /// Returns the raster of the maxima; NaN for cells without a pixel.
  Raster<float>& values() noexcept { return values_; }

 private:
  Raster<float> values_;
};

}  // namespace talus::maps
