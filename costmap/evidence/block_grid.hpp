#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Grid of blocks. A block is a square of cells whose evidence is stored together. The side of a block is the
/// largest power of two of cells, 1 to 256, that does not exceed a quarter of the correlation length of the
/// soil; at least one cell. Blocks are aligned with the octree. A block is identified by its south-west cell,
/// which may lie outside the map, or by its column and row from the map's south-west corner. Immutable.
class BlockGrid {
 public:
  explicit BlockGrid(std::shared_ptr<const GroundSite> site);

  int columns() const noexcept { return columns_; }
  int rows() const noexcept { return rows_; }
  /// Returns the side length of a block: side() in cells, side_m() in metres.
  int side() const noexcept { return 1 << shift_; }
  double side_m() const noexcept { return side() * site_->grid().resolution_m; }
  /// Returns the number of blocks that one correlation length spans, rounded up.
  int reach() const noexcept;

  /// Returns the column and the row of the block that contains a cell.
  int columnOf(maps::Cell cell) const noexcept { return (cell.column - first_.column) >> shift_; }
  int rowOf(maps::Cell cell) const noexcept { return (cell.row - first_.row) >> shift_; }
  /// Returns the south-west cell of a block: blockOf() of the block that contains a cell, blockAt() of the
  /// block in a column and row.
  maps::Cell blockOf(maps::Cell cell) const noexcept;
  maps::Cell blockAt(int column, int row) const noexcept {
    return {first_.column + column * side(), first_.row + row * side()};
  }
  /// Returns the map coordinates of the middle of a block.
  maps::Point middleOf(maps::Cell block) const noexcept;

 private:
  std::shared_ptr<const GroundSite> site_;
  int shift_;
  maps::Cell first_;
  int columns_, rows_;
};

}  // namespace talus::costmap
