#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {
namespace {

int tilesAcross(int cells) {
  return (cells + CostTile::kSide - 1) / CostTile::kSide;
}

template <typename T>
std::shared_ptr<const Tile<T>> cutTile(const maps::Raster<T>& cells, maps::Cell first) {
  auto tile = std::make_shared<Tile<T>>();
  for (int r = 0; r < CostTile::kSide; ++r)
    for (int c = 0; c < CostTile::kSide; ++c) {
      const maps::Cell cell{first.column + c, first.row + r};
      if (cells.grid().contains(cell))
        tile->cells[static_cast<std::size_t>(r * CostTile::kSide + c)] = cells[cell];
    }
  return tile;
}

template <typename T>
SharedTiles<T> cut(const maps::Raster<T>& cells) {
  std::vector<typename SharedTiles<T>::Shared> tiles;
  for (int row = 0; row < cells.grid().height; row += CostTile::kSide)
    for (int column = 0; column < cells.grid().width; column += CostTile::kSide)
      tiles.push_back(cutTile(cells, {column, row}));
  return SharedTiles<T>(tiles);
}

}  // namespace

template <typename T>
SharedTiles<T>::SharedTiles(std::size_t tiles, const Shared& each)
    : SharedTiles(std::vector<Shared>(tiles, each)) {}

template <typename T>
SharedTiles<T>::SharedTiles(const std::vector<Shared>& tiles) {
  for (std::size_t first = 0; first < tiles.size(); first += kPage) {
    auto page = std::make_shared<Page>();
    for (std::size_t i = first; i < std::min(first + kPage, tiles.size()); ++i) {
      (*page)[i - first] = tiles[i];
      raw_.push_back(tiles[i].get());
    }
    pages_.push_back(std::move(page));
  }
}

template <typename T>
void SharedTiles<T>::set(std::size_t i, Shared tile) {
  auto page = std::make_shared<Page>(*pages_[i / kPage]);
  raw_[i] = tile.get();
  (*page)[i % kPage] = std::move(tile);
  pages_[i / kPage] = std::move(page);
}

template class SharedTiles<CellCode>;
template class SharedTiles<float>;

HeightTable tiled(const maps::Raster<float>& elevation_m) {
  return cut(elevation_m);
}

HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box) {
  const int columns = tilesAcross(elevation_m.grid().width);
  for (int row = box.first.row >> 6; row <= box.last.row >> 6; ++row)
    for (int column = box.first.column >> 6; column <= box.last.column >> 6; ++column)
      table.set(static_cast<std::size_t>(row * columns + column),
                cutTile(elevation_m, {column << 6, row << 6}));
  return table;
}

CostGrid::CostGrid(Content content)
    : content_(std::move(content)), tile_columns_(tilesAcross(content_.grid.width)) {
  const auto expected =
      static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tilesAcross(content_.grid.height));
  if (content_.tiles.size() != expected)
    throw std::invalid_argument("CostGrid: " + std::to_string(content_.tiles.size()) + " tiles, must be " +
                                std::to_string(expected));
  if (!content_.cost) throw std::invalid_argument("CostGrid: no cost function");
  if (const std::size_t heights = content_.elevation_m.size(); heights != 0 && heights != expected)
    throw std::invalid_argument("CostGrid: " + std::to_string(heights) +
                                " tiles of elevation, must be 0 or " + std::to_string(expected));
}

std::optional<double> CostGrid::elevation_m(maps::Point point) const {
  if (content_.elevation_m.size() == 0) return std::nullopt;
  return maps::elevationAt(content_.grid, point, [&](maps::Cell c) {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.elevation_m.tile(tile)
        .cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  });
}

CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const TravelCost> cost) {
  return CostGrid({.grid = cells.grid(), .tiles = cut(cells), .cost = std::move(cost), .version = 1});
}

CostGrid revised(const CostGrid& grid, const Revision& revision) {
  CostGrid::Content next = grid.content();
  std::vector<std::pair<std::size_t, std::shared_ptr<CostTile>>> copies;
  const auto writable = [&](std::size_t slot) -> CostTile& {
    const auto known =
        std::find_if(copies.begin(), copies.end(), [&](const auto& copy) { return copy.first == slot; });
    if (known != copies.end()) return *known->second;
    copies.emplace_back(slot, std::make_shared<CostTile>(*next.tiles[slot]));
    next.tiles.set(slot, copies.back().second);
    return *copies.back().second;
  };
  for (const maps::CellBox& range : revision.ranges)
    for (int tile_row = range.first.row >> 6; tile_row <= range.last.row >> 6; ++tile_row)
      for (int tile_column = range.first.column >> 6; tile_column <= range.last.column >> 6; ++tile_column) {
        CostTile& tile = writable(static_cast<std::size_t>(tile_row * grid.tileColumns() + tile_column));
        for (int row = std::max(range.first.row, tile_row << 6);
             row <= std::min(range.last.row, tile_row << 6 | 63); ++row)
          for (int column = std::max(range.first.column, tile_column << 6);
               column <= std::min(range.last.column, tile_column << 6 | 63); ++column) {
            CellCode& code = tile.cells[static_cast<std::size_t>((row & 63) << 6 | (column & 63))];
            code = revision.code({column, row}, code);
          }
      }
  next.cost = revision.cost();
  if (revision.elevation_m) next.elevation_m = *revision.elevation_m;
  ++next.version;
  return CostGrid(std::move(next));
}

}  // namespace talus::costmap
