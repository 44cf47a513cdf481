#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::costmap {

// The bits of a planner's costs in a cell for sixteen headings.
inline std::array<std::uint32_t, 16> costBits(const CostGrid& grid, maps::Cell cell) {
  std::array<std::uint32_t, 16> bits{};
  for (std::size_t k = 0; k < bits.size(); ++k) {
    const double heading = 0.3926990817 * static_cast<double>(k);
    bits[k] = std::bit_cast<std::uint32_t>(
        grid.cost().costPerMetre(grid.at(cell), {std::cos(heading), std::sin(heading)}));
  }
  return bits;
}

}  // namespace talus::costmap
