#include <algorithm>

#include <talus/planner/field/map_change.hpp>

namespace talus::planner {

std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer) {
  constexpr int kSide = costmap::CostTile::kSide;
  const maps::Grid& grid = old.grid();
  CellBox box{{grid.width, grid.height}, {-1, -1}};
  for (std::size_t t = 0; t < old.content().tiles.size(); ++t) {
    if (old.content().tiles[t] == newer.content().tiles[t]) continue;
    const int row0 = static_cast<int>(t) / old.tileColumns() * kSide,
              column0 = static_cast<int>(t) % old.tileColumns() * kSide;
    for (int row = row0; row < std::min(row0 + kSide, grid.height); ++row)
      for (int column = column0; column < std::min(column0 + kSide, grid.width); ++column) {
        if (old.at({column, row}) == newer.at({column, row})) continue;
        box.first = {std::min(box.first.column, column), std::min(box.first.row, row)};
        box.last = {std::max(box.last.column, column), std::max(box.last.row, row)};
      }
  }
  if (box.last.column < 0) return std::nullopt;
  return box;
}

}  // namespace talus::planner
