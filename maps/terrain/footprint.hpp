#pragma once

#include <vector>

namespace talus::maps {

/// The cells under a rover, as offsets from the cell it stands on: symmetric, so that the sums of dx, of dy
/// and of dx dy vanish and those of dx^2 and dy^2 are equal.
struct Footprint {
  struct Offset {
    int column = 0;
    int row = 0;
  };

  std::vector<Offset> offsets;  ///< south to north, west to east
  int reach = 0;                ///< largest offset [cells]
  double sum_xx = 0.0;          ///< of column^2 over the offsets [cells^2]
};

/// Cells whose centres lie within a radius [cells] >= sqrt(2); a smaller one gives the 3x3 block.
Footprint discFootprint(double radius_cells);

}  // namespace talus::maps
