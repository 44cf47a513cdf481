#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::costmap {

/// Returns the cost map with other cost weights. The result shares the tiles (blocks of 64x64 cells) of `map`
/// and refuses the same motions. Throws std::domain_error if a cost curve of the map has no
/// GroundCost::states, and std::invalid_argument for a negative weight.
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights);

/// Sparse grid of 32-bit words for cells with learned values; all other cells have the word 0. Memory is
/// allocated only for tiles (blocks of 64x64 cells) with non-zero words.
class LearnedCells {
 public:
  explicit LearnedCells(const maps::Grid& grid);

  /// Returns the word of a cell.
  std::uint32_t operator[](maps::Cell cell) const noexcept {
    const auto& tile = tiles_[slot(cell)];
    return tile ? tile->words[inside(cell)] : 0U;
  }
  /// Sets the word of a cell; returns false if unchanged.
  bool set(maps::Cell cell, std::uint32_t word);

  /// Returns one box for each tile, which bounds the cells of the tile that were ever set, in a fixed order.
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

/// Holder of the current version of the cost grid; a new version replaces the current one as a whole. load()
/// is thread-safe. The class uses a mutex because std::atomic<std::shared_ptr> of GCC 12 unlocks without
/// memory ordering: on a weakly ordered processor, a reader could combine one grid with the reference count
/// of another.
class PublishedGrid {
 public:
  std::shared_ptr<const CostGrid> load() const {
    const std::lock_guard lock(mutex_);
    return grid_;
  }
  void store(std::shared_ptr<const CostGrid> next) {
    const std::lock_guard lock(mutex_);
    grid_.swap(next);  // the previous version is destroyed after the unlock
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const CostGrid> grid_;
};

}  // namespace talus::costmap
