#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// 64x64 cells, row-major from the south-west corner.
template <typename T>
struct Tile {
  static constexpr int kSide = 64;
  std::array<T, kSide * kSide> cells;
};

using CostTile = Tile<CellCode>;
using HeightTile = Tile<float>;

/// The tiles of a map, row-major. Copies share them by pages of 64, so that a copy costs next to nothing
/// whatever the size of the map; changing one tile of a copy takes over its page alone.
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

  std::vector<const Tile<T>*> raw_;                 // what readers follow
  std::vector<std::shared_ptr<const Page>> pages_;  // what keeps them alive
};

using TileTable = SharedTiles<CellCode>;
using HeightTable = SharedTiles<float>;

/// A raster cut into tiles; those over the east and north edge are padded.
HeightTable tiled(const maps::Raster<float>& elevation_m);

/// The table with the tiles that a box of cells touches cut anew; the others are shared.
HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box);

/// One version of the map as planners read it: immutable, so readers never wait and writers never wait for
/// readers. Versions share the tiles that did not change.
class CostGrid {
 public:
  /// The content of one version.
  struct Content {
    maps::Grid grid;
    TileTable tiles;  ///< those over the east and north edge are padded
    std::shared_ptr<const DriveCost> cost;
    std::uint64_t version = 0;
    HeightTable elevation_m{};  ///< NaN where not observed; no tiles: not known
  };

  explicit CostGrid(Content content);

  const maps::Grid& grid() const noexcept { return content_.grid; }
  const DriveCost& cost() const noexcept { return *content_.cost; }
  const Content& content() const noexcept { return content_; }
  std::uint64_t version() const noexcept { return content_.version; }
  int tileColumns() const noexcept { return tile_columns_; }

  /// The cell's code; the cell must lie inside the grid.
  CellCode at(maps::Cell c) const noexcept {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.tiles.tile(tile).cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  }

  /// Elevation of the ground [m] as maps::elevationAt() has it; nothing where it is not known.
  std::optional<double> elevation_m(maps::Point point) const;

 private:
  Content content_;
  int tile_columns_;
};

/// Cuts a raster of cell codes into a first version.
CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const DriveCost> cost);

/// What a new version changes.
struct Revision {
  std::vector<maps::CellBox> ranges;  ///< inside the grid; nothing else changes
  /// The new code of a cell of the ranges, given its old one.
  std::function<CellCode(maps::Cell, CellCode)> code;
  /// Of the new version, asked once all codes are known.
  std::function<std::shared_ptr<const DriveCost>()> cost;
  std::optional<HeightTable> elevation_m{};  ///< of the new version; none: those of the old one
};

/// The next version: copies the tiles that the ranges touch and shares the others.
CostGrid revised(const CostGrid& grid, const Revision& revision);

}  // namespace talus::costmap
