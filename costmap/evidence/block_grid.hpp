#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Square blocks of cells, in which evidence is stored. The side of a block is the largest power of two of
/// cells, 1 to 256, that does not exceed a quarter of the correlation length; at least one cell. Blocks are
/// aligned with the octree. A block is identified by its south-west cell, which may lie outside the grid, or
/// by its column and row from the map's south-west. Immutable.
class BlockGrid {
 public:
  explicit BlockGrid(std::shared_ptr<const GroundSite> site);

  int columns() const noexcept { return columns_; }
  int rows() const noexcept { return rows_; }
  /// Side of a block, in cells and in metres.
  int side() const noexcept { return 1 << shift_; }
  double side_m() const noexcept { return side() * site_->grid().resolution_m; }
  /// Number of blocks that a correlation length spans, rounded up.
  int reach() const noexcept;

  int columnOf(maps::Cell cell) const noexcept { return (cell.column - first_.column) >> shift_; }
  int rowOf(maps::Cell cell) const noexcept { return (cell.row - first_.row) >> shift_; }
  /// South-west cell of the block that contains a cell, and of the block in a column and row.
  maps::Cell blockOf(maps::Cell cell) const noexcept;
  maps::Cell blockAt(int column, int row) const noexcept {
    return {first_.column + column * side(), first_.row + row * side()};
  }
  maps::Point middleOf(maps::Cell block) const noexcept;

  /// keyOf(): octree height key of an elevation. topKey(): key of the first cell with an elevation in a
  /// block; nullopt if no cell of the block has an elevation.
  std::uint16_t keyOf(float height_m) const noexcept;
  std::optional<std::uint16_t> topKey(maps::Cell block) const noexcept;

 private:
  std::shared_ptr<const GroundSite> site_;
  int shift_;
  maps::Cell first_;
  int columns_, rows_;
};

}  // namespace talus::costmap
