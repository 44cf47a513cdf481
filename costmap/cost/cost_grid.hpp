#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// A block of 64x64 cells, row-major from the south-west corner.
template <typename T>
struct Tile {
  static constexpr int kSide = 64;
  std::array<T, kSide * kSide> cells;
};

using CostTile = Tile<CellCode>;
using HeightTile = Tile<float>;

/// The tiles of a map, row-major, with copy-on-write in pages of 64 tiles. A copy of the table copies
/// pointers only; a change of one tile copies the page of that tile.
template <typename T>
class SharedTiles {
 public:
  using Shared = std::shared_ptr<const Tile<T>>;

  SharedTiles() = default;
  SharedTiles(std::size_t tiles, const Shared& each);
  explicit SharedTiles(const std::vector<Shared>& tiles);

  std::size_t size() const noexcept { return raw_.size(); }
  const Tile<T>& tile(std::size_t i) const noexcept { return *raw_[i]; }
  const Shared& operator[](std::size_t i) const noexcept { return (*pages_[i / kPage])[i % kPage]; }
  void set(std::size_t i, Shared tile);

 private:
  static constexpr std::size_t kPage = 64;
  using Page = std::array<Shared, kPage>;

  std::vector<const Tile<T>*> raw_;                 // direct access for readers
  std::vector<std::shared_ptr<const Page>> pages_;  // ownership of the tiles
};

using TileTable = SharedTiles<CellCode>;
using HeightTable = SharedTiles<float>;

/// Divides a raster into tiles; tiles beyond the eastern and northern edge are padded.
HeightTable tiled(const maps::Raster<float>& elevation_m);

/// Returns the table with new tiles for the cells of a box; other tiles are shared.
HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box);

/// One version of the cost map for planners. Immutable: readers need no lock and never block the writer.
/// Versions share unchanged tiles.
class CostGrid {
 public:
  /// Content of one version.
  struct Content {
    maps::Grid grid;
    TileTable tiles;  ///< tiles beyond the eastern and northern edge are padded
    std::shared_ptr<const TravelCost> cost;
    std::uint64_t version = 0;
    HeightTable elevation_m{};  ///< NaN for unobserved cells; a table without tiles has no elevations
  };

  explicit CostGrid(Content content);

  const maps::Grid& grid() const noexcept { return content_.grid; }
  const TravelCost& cost() const noexcept { return *content_.cost; }
  const Content& content() const noexcept { return content_; }
  std::uint64_t version() const noexcept { return content_.version; }
  int tileColumns() const noexcept { return tile_columns_; }

  /// Returns the cell code (gradients and curve index) of a cell, which must lie inside the grid.
  CellCode at(maps::Cell c) const noexcept {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.tiles.tile(tile).cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  }

  /// Elevation of the ground [m] by maps::elevationAt(); nullopt if unknown.
  std::optional<double> elevation_m(maps::Point point) const;

 private:
  Content content_;
  int tile_columns_;
};

/// First version of a cost map, from a raster of cell codes.
CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const TravelCost> cost);

/// Changes from one version to the next.
struct Revision {
  std::vector<maps::CellBox> ranges;  ///< the changed cells, inside the grid
  /// New code of a cell of the ranges, from its position and its old code.
  std::function<CellCode(maps::Cell, CellCode)> code;
  /// Returns the cost function of the new version. Is called after `code` was called for all changed cells.
  std::function<std::shared_ptr<const TravelCost>()> cost;
  std::optional<HeightTable> elevation_m{};  ///< elevation of the new version; nullopt: unchanged
};

/// Returns the next version of the grid: copies the tiles that overlap the ranges and shares all others.
CostGrid revised(const CostGrid& grid, const Revision& revision);

}  // namespace talus::costmap
