#pragma once

#include <array>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// The greatest value of all pixels that reach into each cell of a grid, whatever the size, angle and shape of the pixels:
/// a cell and a pixel overlap unless a side of one of them has the other beyond it (separating axes of convex polygons).
/// What reaches in by less than a thousandth of a cell only touches, so that rounding lets nothing reach into the next cell.
class PixelCover {
 public:
  explicit PixelCover(const Grid& grid);

  /// A pixel by its corners in order, in metres from the grid's south-west corner. One whose value is NaN, or that has a
  /// corner that is not finite, is left out.
  void add(const std::array<Point, 4>& corners, float value);

  /// NaN where no pixel reached.
  Raster<float>& values() noexcept { return values_; }

 private:
  Raster<float> values_;
};

}  // namespace talus::maps
