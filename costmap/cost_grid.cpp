#include <stdexcept>
#include <string>
#include <utility>

#include <costmap/cost_grid.hpp>

namespace talus::costmap {
namespace {

int tilesAcross(int cells) {
  return (cells + CostTile::kSide - 1) / CostTile::kSide;
}

std::shared_ptr<const CostTile> cutTile(const maps::Raster<CellCode>& cells, maps::Cell first) {
  auto tile = std::make_shared<CostTile>();
  for (int r = 0; r < CostTile::kSide; ++r)
    for (int c = 0; c < CostTile::kSide; ++c) {
      const maps::Cell cell{first.column + c, first.row + r};
      if (cells.grid().contains(cell))
        tile->cells[static_cast<std::size_t>(r * CostTile::kSide + c)] = cells[cell];
    }
  return tile;
}

}  // namespace

CostGrid::CostGrid(Content content)
    : content_(std::move(content)), tile_columns_(tilesAcross(content_.grid.width)) {
  const auto expected =
      static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tilesAcross(content_.grid.height));
  if (content_.tiles.size() != expected)
    throw std::invalid_argument("CostGrid: " + std::to_string(content_.tiles.size()) + " tiles, must be " +
                                std::to_string(expected));
  if (!content_.cost) throw std::invalid_argument("CostGrid: no cost function");
}

CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const DriveCost> cost) {
  CostGrid::Tiles tiles;
  for (int row = 0; row < cells.grid().height; row += CostTile::kSide)
    for (int column = 0; column < cells.grid().width; column += CostTile::kSide)
      tiles.push_back(cutTile(cells, {column, row}));
  return CostGrid({.grid = cells.grid(), .tiles = std::move(tiles), .cost = std::move(cost), .version = 1});
}

}  // namespace talus::costmap
