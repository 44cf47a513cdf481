#include <algorithm>

#include <talus/costmap/ground/class_borders.hpp>

namespace talus::costmap {
namespace {

// For each column of a row: true if all cells within `reach` columns have the same class.
std::vector<bool> alikeAlong(const maps::Raster<std::uint8_t>& classes, int row, int reach) {
  const int width = classes.grid().width;
  std::vector<bool> alike(static_cast<std::size_t>(width), true);
  for (int column = 1; column < width; ++column) {
    if (classes[{column, row}] == classes[{column - 1, row}]) continue;
    const int first = std::max(column - reach, 0), last = std::min(column + reach, width);
    std::fill(alike.begin() + first, alike.begin() + last, false);
  }
  return alike;
}

}  // namespace

std::vector<bool> classBorders(const maps::Raster<std::uint8_t>& classes, int reach) {
  if (classes.empty()) return {};
  const maps::Grid& grid = classes.grid();
  std::vector<bool> border(grid.size(), true);
  // For each column: number of consecutive rows, up to this row, that are uniform along the row and of one
  // class.
  std::vector<int> rows(static_cast<std::size_t>(grid.width), 0);
  for (int row = 0; row < grid.height + reach; ++row) {
    const bool inside = row < grid.height;
    const std::vector<bool> alike = inside ? alikeAlong(classes, row, reach) : std::vector<bool>{};
    const int judged = row - reach;
    for (int column = 0; column < grid.width; ++column) {
      int& run = rows[static_cast<std::size_t>(column)];
      if (inside) {
        const bool follows = row == 0 || classes[{column, row}] == classes[{column, row - 1}];
        run = !alike[static_cast<std::size_t>(column)] ? 0 : follows ? run + 1 : 1;
      }
      const int last = std::min(row, grid.height - 1);
      if (judged >= 0 && run >= last - std::max(judged - reach, 0) + 1)
        border[grid.index({column, judged})] = false;
    }
  }
  return border;
}

}  // namespace talus::costmap
