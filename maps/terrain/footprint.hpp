#pragma once

#include <vector>

namespace talus::maps {

/// Footprint of a rover: the cells under the rover, as offsets from the cell of its position. The set is
/// symmetric: the sums of column, row and column * row vanish, and the sums of column^2 and row^2 are equal.
struct Footprint {
  struct Offset {
    int column = 0;
    int row = 0;
  };

  std::vector<Offset> offsets;  ///< offsets in order from south to north, then from west to east
  int reach = 0;                ///< greatest magnitude of a column or row offset [cells]
  double sum_xx = 0.0;          ///< sum of column^2 over the offsets [cells^2]
};

/// Returns the footprint of all cells whose centres lie within a radius >= sqrt(2) [cells]; a smaller radius
/// gives 3x3 cells.
Footprint discFootprint(double radius_cells);

}  // namespace talus::maps
