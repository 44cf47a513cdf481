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

/// A tile: a block of 64x64 cells of a map, row-major from the south-west corner.
template <typename T>
struct Tile {
  static constexpr int kSide = 64;
  std::array<T, kSide * kSide> cells;
};

using CostTile = Tile<CellCode>;
using HeightTile = Tile<float>;

/// Table of the tiles of a map, row-major, with copy-on-write in pages of 64 tiles. A copy of the table
/// copies pointers only; a change of one tile copies the pointers of its page.
template <typename T>
class SharedTiles {
 public:
  using Shared = std::shared_ptr<const Tile<T>>;

  SharedTiles() = default;
  /// Makes a table of `tiles` entries that all share the tile `each`.
  SharedTiles(std::size_t tiles, const Shared& each);
  explicit SharedTiles(const std::vector<Shared>& tiles);

  std::size_t size() const noexcept { return raw_.size(); }
  const Tile<T>& tile(std::size_t i) const noexcept { return *raw_[i]; }
  const Shared& operator[](std::size_t i) const noexcept { return (*pages_[i / kPage])[i % kPage]; }
  void set(std::size_t i, Shared tile);

 private:
  static constexpr std::size_t kPage = 64;
  using Page = std::array<Shared, kPage>;

  std::vector<const Tile<T>*> raw_;                 // pointers for direct access by readers
  std::vector<std::shared_ptr<const Page>> pages_;  // pages that own the tiles
};

using TileTable = SharedTiles<CellCode>;
using HeightTable = SharedTiles<float>;

/// Returns the tiles of a raster of elevations [m]; tiles beyond the eastern and northern edge are padded.
HeightTable tiled(const maps::Raster<float>& elevation_m);

/// Returns the table with new tiles for the cells of a box. All other tiles are shared with `table`.
HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box);

/// Cost grid: one version of the cost map for planners. Immutable: readers need no lock and never block the
/// writer. Versions share unchanged tiles.
class CostGrid {
 public:
  /// Content of one version.
  struct Content {
    maps::Grid grid;
    /// Codes of the cells (gradients and index of a cost curve); tiles beyond the eastern and northern edge
    /// are padded.
    TileTable tiles;
    /// Cost function with the cost curves.
    std::shared_ptr<const TravelCost> cost;
    std::uint64_t version = 0;
    /// Elevations [m], NaN for unobserved cells; a table without tiles means no elevations.
    HeightTable elevation_m{};
  };

  explicit CostGrid(Content content);

  const maps::Grid& grid() const noexcept { return content_.grid; }
  const TravelCost& cost() const noexcept { return *content_.cost; }
  const Content& content() const noexcept { return content_; }
  std::uint64_t version() const noexcept { return content_.version; }
  int tileColumns() const noexcept { return tile_columns_; }

  /// Returns the code (gradients and index of a cost curve) of a cell, which must lie inside the grid.
  CellCode at(maps::Cell c) const noexcept {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.tiles.tile(tile).cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  }

  /// Returns the elevation of the ground at a point [m], by maps::elevationAt(); nullopt if unknown.
  std::optional<double> elevation_m(maps::Point point) const;

 private:
  Content content_;
  int tile_columns_;
};

/// Returns the first version of a cost grid, from a raster of cell codes and the cost function.
CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const TravelCost> cost);

/// Changes from one version of a cost grid to the next.
struct Revision {
  std::vector<maps::CellBox> ranges;  ///< boxes of the changed cells, inside the grid
  /// Returns the new code of a cell in `ranges`, from its position and its old code.
  std::function<CellCode(maps::Cell, CellCode)> code;
  /// Returns the cost function of the new version. revised() calls `cost` after `code` was called for all
  /// changed cells.
  std::function<std::shared_ptr<const TravelCost>()> cost;
  std::optional<HeightTable> elevation_m{};  ///< elevations of the new version; nullopt: unchanged
};

/// Returns the next version of the grid: copies the tiles that overlap the changed cells and shares all
/// others.
CostGrid revised(const CostGrid& grid, const Revision& revision);

}  // namespace talus::costmap
