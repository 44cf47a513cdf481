#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/costmap/evidence/block_grid.hpp>

namespace talus::costmap {
namespace {

constexpr double kBlocksPerLength = 4.0;

int shiftFor(double correlation_length_m, double resolution_m) {
  const double cells = correlation_length_m / kBlocksPerLength / resolution_m;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(cells, 1.0)))), 0, 8);
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

}  // namespace talus::costmap
