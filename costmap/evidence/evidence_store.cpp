#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/costmap/evidence/evidence_store.hpp>

namespace talus::costmap {
namespace {

constexpr double kBlocksPerLength = 4.0;

int shiftFor(double correlation_length_m, double resolution_m) {
  const double cells = correlation_length_m / kBlocksPerLength / resolution_m;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(cells, 1.0)))), 0, 8);
}

int patchOf(int block) noexcept {
  return block / EvidenceReach::kPatchBlocks;
}

}  // namespace

BlockGrid::BlockGrid(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)),
      shift_(shiftFor(site_->model->parts().policy.correlation_length_m, site_->grid().resolution_m)),
      first_(blockOf({0, 0})),
      columns_(columnOf({site_->grid().width - 1, 0}) + 1),
      rows_(rowOf({0, site_->grid().height - 1}) + 1) {}

int BlockGrid::reach() const noexcept {
  return static_cast<int>(std::ceil(site_->model->parts().policy.correlation_length_m / side_m()));
}

maps::Cell BlockGrid::blockOf(maps::Cell cell) const noexcept {
  const octomap::OcTreeKey first = site_->keys.key({0, 0}, site_->keys.baseElevation_m());
  const auto snapped = [&](int value, int origin) {
    return static_cast<int>((static_cast<unsigned>(origin + value) >> shift_) << shift_) - origin;
  };
  return {snapped(cell.column, first[0]), snapped(cell.row, first[1])};
}

maps::Point BlockGrid::middleOf(maps::Cell block) const noexcept {
  const maps::Grid& grid = site_->grid();
  const double half = 0.5 * side();
  return {grid.south_west.x_m + (block.column + half) * grid.resolution_m,
          grid.south_west.y_m + (block.row + half) * grid.resolution_m};
}

EvidenceReach::EvidenceReach(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)), blocks_(site_) {}

maps::CellBox EvidenceReach::cellsOf(const maps::CellBox& patches) const noexcept {
  const maps::Grid& grid = site_->grid();
  const maps::Cell first =
                       blocks_.blockAt(patches.first.column * kPatchBlocks, patches.first.row * kPatchBlocks),
                   last = blocks_.blockAt((patches.last.column + 1) * kPatchBlocks,
                                          (patches.last.row + 1) * kPatchBlocks);
  return {{std::max(first.column, 0), std::max(first.row, 0)},
          {std::min(last.column, grid.width) - 1, std::min(last.row, grid.height) - 1}};
}

maps::CellBox EvidenceReach::add(const BlockOfClass& block, double reach_m) {
  farthest_m_ = std::max(farthest_m_, reach_m);
  const double correlation_length_m = site_->model->parts().policy.correlation_length_m;
  const int reach = 1 + static_cast<int>(std::ceil((correlation_length_m + reach_m) / blocks_.side_m()));
  const maps::CellBox patches{
      {patchOf(std::max(block.column - reach, 0)), patchOf(std::max(block.row - reach, 0))},
      {patchOf(std::min(block.column + reach, blocks_.columns() - 1)),
       patchOf(std::min(block.row + reach, blocks_.rows() - 1))}};
  for (int row = patches.first.row; row <= patches.last.row; ++row)
    for (int column = patches.first.column; column <= patches.last.column; ++column)
      patches_.insert({row, column});
  return cellsOf(patches);
}

std::vector<maps::CellBox> EvidenceReach::boxes() const {
  std::vector<maps::CellBox> boxes;
  for (const auto& [row, column] : patches_) boxes.push_back(cellsOf({{column, row}, {column, row}}));
  return boxes;
}

}  // namespace talus::costmap
