#include <algorithm>

#include <talus/costmap/cost/learned_cells.hpp>

namespace talus::costmap {

LearnedCells::LearnedCells(const maps::Grid& grid)
    : tile_columns_((grid.width + CostTile::kSide - 1) / CostTile::kSide),
      tiles_(static_cast<std::size_t>(tile_columns_) *
             static_cast<std::size_t>((grid.height + CostTile::kSide - 1) / CostTile::kSide)) {}

bool LearnedCells::set(maps::Cell cell, std::uint32_t word) {
  std::unique_ptr<Tile>& tile = tiles_[slot(cell)];
  if (!tile) {
    if (word == 0) return false;
    tile = std::make_unique<Tile>();
    tile->box = {cell, cell};
  }
  std::uint32_t& old = tile->words[inside(cell)];
  if (old == word) return false;
  old = word;
  maps::CellBox& box = tile->box;
  box = {{std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)},
         {std::max(box.last.column, cell.column), std::max(box.last.row, cell.row)}};
  return true;
}

std::vector<maps::CellBox> LearnedCells::boxes() const {
  std::vector<maps::CellBox> boxes;
  for (const auto& tile : tiles_)
    if (tile) boxes.push_back(tile->box);
  return boxes;
}

}  // namespace talus::costmap
