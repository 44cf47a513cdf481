#include <algorithm>
#include <cmath>

#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {

std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m) {
  constexpr double kTouch = 2e-6;  // sides: MotionCost treats places this close to a side as on the side
  const double x = (place.x_m - grid.south_west.x_m) / grid.resolution_m;
  const double y = (place.y_m - grid.south_west.y_m) / grid.resolution_m;
  const double reach = radius_m / grid.resolution_m + kTouch;
  std::vector<maps::Cell> cells;
  if (!(std::isfinite(x) && std::isfinite(y))) return cells;
  // Clamps to the map plus one cell, because distant coordinates would overflow an int.
  const auto first = [reach](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at - reach), 0.0, static_cast<double>(count)));
  };
  const auto last = [reach](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at + reach), -1.0, count - 1.0));
  };
  for (int row = first(y, grid.height); row <= last(y, grid.height); ++row)
    for (int column = first(x, grid.width); column <= last(x, grid.width); ++column) {
      const double dx = std::max({column - x, x - column - 1.0, 0.0}),
                   dy = std::max({row - y, y - row - 1.0, 0.0});
      if (dx * dx + dy * dy <= reach * reach) cells.push_back({column, row});
    }
  return cells;
}

}  // namespace talus::planner
