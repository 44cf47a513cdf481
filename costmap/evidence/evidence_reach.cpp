#include <algorithm>
#include <cmath>

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>

// How far evidence goes. Beliefs are worked out a patch of blocks at a time, from all evidence that can reach any of it: what
// changes a block changes whole patches, however their evidence hangs together.
namespace talus::costmap {
namespace {

int patchOf(int block) noexcept {
  return block / EvidenceField::kPatchBlocks;
}

}  // namespace

maps::CellBox EvidenceField::cellsOf(const maps::CellBox& blocks) const noexcept {
  const maps::Grid& grid = site_->grid();
  const maps::Cell first = store_->blocks.blockAt(blocks.first.column, blocks.first.row),
                   last = store_->blocks.blockAt(blocks.last.column + 1, blocks.last.row + 1);
  return {{std::max(first.column, 0), std::max(first.row, 0)},
          {std::min(last.column, grid.width) - 1, std::min(last.row, grid.height) - 1}};
}

// A place that may lie elsewhere reaches as much further.
maps::CellBox EvidenceField::patchesReachedFrom(const BlockLevel& block, double reach_m) {
  const BlockGrid& grid = store_->blocks;
  const double correlation_length_m = site_->model->parts().policy.correlation_length_m;
  const int reach = 1 + static_cast<int>(std::ceil((correlation_length_m + reach_m) / grid.side_m()));
  const maps::CellBox patches{
      {patchOf(std::max(block.column - reach, 0)), patchOf(std::max(block.row - reach, 0))},
      {patchOf(std::min(block.column + reach, grid.columns() - 1)),
       patchOf(std::min(block.row + reach, grid.rows() - 1))}};
  for (int row = patches.first.row; row <= patches.last.row; ++row)
    for (int column = patches.first.column; column <= patches.last.column; ++column)
      store_->reached.insert({row, column});
  return cellsOf({{patches.first.column * kPatchBlocks, patches.first.row * kPatchBlocks},
                  {(patches.last.column + 1) * kPatchBlocks - 1, (patches.last.row + 1) * kPatchBlocks - 1}});
}

std::vector<maps::CellBox> EvidenceField::reached() const {
  std::vector<maps::CellBox> boxes;
  for (const auto& [row, column] : store_->reached)
    boxes.push_back(cellsOf({{column * kPatchBlocks, row * kPatchBlocks},
                             {(column + 1) * kPatchBlocks - 1, (row + 1) * kPatchBlocks - 1}}));
  return boxes;
}

}  // namespace talus::costmap
