#include <algorithm>
#include <cmath>

#include <talus/planner/refine/corridor.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

// Returns the cells along a path, sampled at steps of less than a cell.
std::vector<Cell> cellsOf(const maps::Grid& grid, const std::vector<Point>& along) {
  std::vector<Cell> on;
  const auto add = [&](double x, double y) {
    const Cell c{std::clamp(static_cast<int>(x), 0, grid.width - 1),
                 std::clamp(static_cast<int>(y), 0, grid.height - 1)};
    if (on.empty() || !(on.back() == c)) on.push_back(c);
  };
  const auto inCells = [&](Point p) {
    return EdgeSpot{(p.x_m - grid.south_west.x_m) / grid.resolution_m,
                    (p.y_m - grid.south_west.y_m) / grid.resolution_m};
  };
  EdgeSpot before = inCells(along.front());
  for (const Point p : along) {
    const EdgeSpot here = inCells(p);
    const int steps =
        1 + static_cast<int>(std::max(std::abs(here.x - before.x), std::abs(here.y - before.y)));
    for (int k = 1; k <= steps; ++k)
      add(before.x + (here.x - before.x) * k / steps, before.y + (here.y - before.y) * k / steps);
    before = here;
  }
  return on;
}

}  // namespace

Corridor::Corridor(const costmap::CostGrid& map, const EdgeCrossings& crossings,
                   const std::vector<Point>& along, int reach_cells)
    : first_{map.grid().width, map.grid().height} {
  const auto on = cellsOf(map.grid(), along);
  Cell last{-1, -1};
  for (const Cell c : on) {
    first_ = {std::min(first_.column, c.column), std::min(first_.row, c.row)};
    last = {std::max(last.column, c.column), std::max(last.row, c.row)};
  }
  const int margin = reach_cells + 2;
  first_ = {first_.column - margin, first_.row - margin};
  columns_ = static_cast<std::size_t>(last.column + margin - first_.column + 1);
  const std::size_t cells = columns_ * static_cast<std::size_t>(last.row + margin - first_.row + 1);
  codes_.assign(cells, costmap::CellCode());
  free_.assign(cells, 0);
  open_.assign(cells, 0);
  holder_.assign(cells, kNone);
  for (const Cell c : on) open(map, crossings, c, reach_cells);
}

void Corridor::open(const costmap::CostGrid& map, const EdgeCrossings& crossings, Cell around,
                    int reach_cells) {
  const int last_row = std::min(around.row + reach_cells, map.grid().height - 1),
            last_column = std::min(around.column + reach_cells, map.grid().width - 1);
  for (int row = std::max(around.row - reach_cells, 0); row <= last_row; ++row)
    for (int column = std::max(around.column - reach_cells, 0); column <= last_column; ++column) {
      const std::size_t at = local({column, row});
      if (open_[at] != 0) continue;
      open_[at] = 1;
      codes_[at] = map.at({column, row});
      free_[at] = crossings.free(codes_[at]) ? 1 : 0;
      hold(at);
    }
}

void Corridor::hold(std::size_t cell) {
  for (const std::size_t each : {cell, cell + 1, cell + columns_}) {
    if (holder_[each] != kNone) continue;
    holder_[each] = static_cast<std::uint32_t>(held_.size());
    held_.push_back(static_cast<std::uint32_t>(each));
  }
}

}  // namespace talus::planner
