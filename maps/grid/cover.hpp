#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <talus/maps/maps.hpp>

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

/// A closed polyline, given by its vertices in map coordinates [m]; the last vertex is joined to the first.
using Ring = std::vector<Point>;

/// A polygon with holes. Its area consists of the points with a non-zero winding number of the outer ring,
/// except those inside an odd number of holes. A ring drawn twice therefore covers the same area as a ring
/// drawn once, and an island inside a hole belongs to the polygon.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// Returns true if the polygon, i.e. the outer ring minus the holes, has an area. Slivers thinner than 1e-9
/// of the ring's extent are ignored, because rounding causes such slivers if a hole coincides with the ring.
bool enclosesGround(const Polygon& polygon);

/// Sets to 1 each cell of `mask` that contains a point of the polygon or of its boundary; other cells are
/// unchanged. A point on the border of two cells belongs to the eastern or northern cell. @return true if any
/// cell of the grid was set
bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask);

}  // namespace talus::maps
