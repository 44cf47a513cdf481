#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::costmap {

/// Sparse grid of 32-bit words for cells with learned values; 0 elsewhere. Memory is allocated for tiles with
/// non-zero words only.
class LearnedCells {
 public:
  explicit LearnedCells(const maps::Grid& grid);

  std::uint32_t operator[](maps::Cell cell) const noexcept {
    const auto& tile = tiles_[slot(cell)];
    return tile ? tile->words[inside(cell)] : 0U;
  }
  /// Sets the word of a cell; returns false if unchanged.
  bool set(maps::Cell cell, std::uint32_t word);

  /// Bounding boxes of all cells ever set, one for each tile, in a fixed order.
  std::vector<maps::CellBox> boxes() const;

 private:
  struct Tile {
    std::array<std::uint32_t, CostTile::kSide * CostTile::kSide> words{};
    maps::CellBox box;
  };
  std::size_t slot(maps::Cell cell) const noexcept {
    return static_cast<std::size_t>((cell.row >> 6) * tile_columns_ + (cell.column >> 6));
  }
  static std::size_t inside(maps::Cell cell) noexcept {
    return static_cast<std::size_t>((cell.row & 63) << 6 | (cell.column & 63));
  }

  int tile_columns_;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

}  // namespace talus::costmap
