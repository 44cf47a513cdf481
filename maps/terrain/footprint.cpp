#include <cmath>

#include <talus/maps/terrain/footprint.hpp>

namespace talus::maps {

Footprint discFootprint(double radius_cells) {
  // A radius of sqrt(2) includes the diagonal neighbours: the 3x3 block.
  const double squared = std::fmax(radius_cells * radius_cells, 2.0) * (1 + 1e-12);
  Footprint out;
  out.reach = static_cast<int>(std::sqrt(squared));
  for (int row = -out.reach; row <= out.reach; ++row)
    for (int column = -out.reach; column <= out.reach; ++column) {
      if (column * column + row * row > squared) continue;
      out.offsets.push_back({column, row});
      out.sum_xx += column * column;
    }
  return out;
}

}  // namespace talus::maps
