#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Positions in map metres; the last is joined to the first.
using Ring = std::vector<Point>;

/// What its outer ring winds round at least once in sum (non-zero winding, so that a ring drawn twice or over itself
/// counts as once), less the ground that its holes wind round an odd number of times together: an island in a hole stays.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// Whether any of the ground inside the outer ring is left by the holes. Slivers thinner than a billionth of the
/// ring's extent count as none: rounding makes those of a hole upon its own ring.
bool enclosesGround(const Polygon& polygon);

/// Sets every cell to 1 that has a point of the polygon, its boundary included; a point between two cells belongs to the
/// eastern and the northern one. Clears none. @return whether it has a point on the grid
bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask);

}  // namespace talus::maps
