#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <talus/costmap/surface/floors.hpp>

namespace talus::costmap {

Floors::Floors(std::vector<Floor> floors, std::size_t cells) : floors_(std::move(floors)) {
  for (const Floor& floor : floors_)
    if (floor.cell >= cells || !std::isfinite(floor.height_m))
      throw std::invalid_argument("Floors: a floor of cell " + std::to_string(floor.cell) + " at " +
                                  std::to_string(floor.height_m) + " m, must be a height in one of " +
                                  std::to_string(cells) + " cells");
  std::sort(floors_.begin(), floors_.end(), [](const Floor& a, const Floor& b) {
    return std::tie(a.cell, a.height_m) < std::tie(b.cell, b.height_m);
  });
}

std::span<const Floor> Floors::of(std::size_t cell) const noexcept {
  const auto [first, last] = std::equal_range(
      floors_.begin(), floors_.end(), Floor{.cell = static_cast<std::uint32_t>(cell), .height_m = 0.0F},
      [](const Floor& a, const Floor& b) { return a.cell < b.cell; });
  return {first, last};
}

std::optional<Floor> Floors::under(std::size_t cell, double height_m, double top_m) const noexcept {
  std::optional<Floor> nearest;
  double distance_m = std::abs(top_m - height_m);
  for (const Floor& floor : of(cell)) {
    const double away_m = std::abs(static_cast<double>(floor.height_m) - height_m);
    if (!(away_m < distance_m)) continue;
    nearest = floor;
    distance_m = away_m;
  }
  return nearest;
}

}  // namespace talus::costmap
