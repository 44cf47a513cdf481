#pragma once

#include <vector>

namespace talus::maps {

/// The cells under a rover, as offsets from the cell of its position. The set is symmetric: the sums of dx,
/// dy and dx dy vanish, and those of dx^2 and dy^2 are equal.
struct Footprint {
  struct Offset {
    int column = 0;
    int row = 0;
  };

  std::vector<Offset> offsets;  ///< in order from south to north, then west to east
  int reach = 0;                ///< largest offset [cells]
  double sum_xx = 0.0;          ///< sum of column^2 over the offsets [cells^2]
};

/// The cells whose centres lie within a radius [cells] >= sqrt(2); a smaller radius gives the 3x3 block.
Footprint discFootprint(double radius_cells);

}  // namespace talus::maps
