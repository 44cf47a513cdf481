#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

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
