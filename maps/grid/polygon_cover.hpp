#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Vertices [m] in map coordinates; the last vertex is joined to the first.
using Ring = std::vector<Point>;

/// The area with a non-zero winding number of the outer ring, minus the area that lies inside an odd number
/// of holes. A ring drawn twice therefore covers the same area as a ring drawn once, and an island inside a
/// hole remains.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// True if the polygon, i.e. the outer ring minus the holes, has an area. Slivers thinner than 1e-9 of the
/// ring's extent are ignored, because rounding causes such slivers if a hole coincides with the ring.
bool enclosesGround(const Polygon& polygon);

/// Sets to 1 each cell that contains a point of the polygon or of its boundary. A point on the border of two
/// cells belongs to the eastern or northern cell. Other cells are unchanged. @return true if any cell of the
/// grid was set
bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask);

}  // namespace talus::maps
