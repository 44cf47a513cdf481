#include <algorithm>
#include <cmath>

#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {

std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m) {
  constexpr double kTouch = 2e-6;  // sides: MotionCost takes what lies so near to a side to lie on it
  const double x = (place.x_m - grid.south_west.x_m) / grid.resolution_m;
  const double y = (place.y_m - grid.south_west.y_m) / grid.resolution_m;
  const double reach = radius_m / grid.resolution_m + kTouch;
  const auto first = [reach](double at) { return static_cast<int>(std::max(0.0, std::floor(at - reach))); };
  const auto last = [reach](double at, int count) {
    return static_cast<int>(std::min(count - 1.0, std::floor(at + reach)));
  };
  std::vector<maps::Cell> cells;
  for (int row = first(y); row <= last(y, grid.height); ++row)
    for (int column = first(x); column <= last(x, grid.width); ++column) {
      const double dx = std::max({column - x, x - column - 1.0, 0.0}),
                   dy = std::max({row - y, y - row - 1.0, 0.0});
      if (dx * dx + dy * dy <= reach * reach) cells.push_back({column, row});
    }
  return cells;
}

}  // namespace talus::planner
