#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>
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

/// Set of the patches that evidence can affect. A patch is 8x8 blocks, and a block is a square of cells whose
/// evidence is stored together. The estimates of a patch are computed from all evidence that can affect any
/// block of the patch; a changed block therefore changes whole patches. Not thread-safe while changed.
class EvidenceReach {
 public:
  static constexpr int kPatchBlocks = 8;

  explicit EvidenceReach(std::shared_ptr<const GroundSite> site);

  /// Adds the evidence of a block whose position uncertainty is reach_m >= 0 [m]. Returns the box of the
  /// cells of all patches within the correlation length plus reach_m of the block.
  maps::CellBox add(const BlockOfClass& block, double reach_m);

  /// Returns the boxes of cells that evidence can affect, one for each patch.
  std::vector<maps::CellBox> boxes() const;

  /// Returns the greatest position uncertainty of a block [m].
  double farthest_m() const noexcept { return farthest_m_; }

 private:
  maps::CellBox cellsOf(const maps::CellBox& patches) const noexcept;

  std::shared_ptr<const GroundSite> site_;
  BlockGrid blocks_;
  std::set<std::pair<int, int>> patches_;  // patches by row and column
  double farthest_m_ = 0.0;
};

/// Data of an EvidenceField: blocks (squares of cells), their readings, the evidence of terrain classes, and
/// the patches of blocks that evidence can affect. Internal to EvidenceField and to the computation of
/// estimates.
struct EvidenceStore {
  explicit EvidenceStore(std::shared_ptr<const GroundSite> of)
      : site(std::move(of)),
        blocks(site),
        reach(site),
        classes(site->model->parts().classes.begin(), site->model->parts().classes.end()) {}

  std::shared_ptr<const GroundSite> site;
  BlockGrid blocks;
  std::map<BlockOfClass, BlockEvidence> evidence{};
  EvidenceReach reach;
  /// Evidence of each terrain class, in the order of the model's classes.
  std::vector<ClassEvidence> classes;

  /// Calls visit(block, evidence) for all evidence in a rectangle of blocks, columns and rows included.
  template <typename Visit>
  void visit(const maps::CellBox& box, Visit visit) const {
    for (int row = box.first.row; row <= box.last.row; ++row)
      for (auto at = evidence.lower_bound({box.first.column, row, 0});
           at != evidence.end() && at->first.row == row && at->first.column <= box.last.column; ++at)
        visit(at->first, at->second);
  }
  const GroundModel& model() const noexcept { return *site->model; }
  const GroundClass& groundClass(int class_index) const noexcept {
    return model().parts().classes[static_cast<std::size_t>(class_index)];
  }
  /// Returns the key of the evidence of a class on the top surface, in the block that contains a cell.
  BlockOfClass topOf(maps::Cell cell, int class_index) const noexcept {
    return {blocks.columnOf(cell), blocks.rowOf(cell),
            static_cast<std::uint8_t>(groundClass(class_index).number)};
  }
};

}  // namespace talus::costmap
