#include "nav2_layer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include <nav2_costmap_2d/cost_values.hpp>
#include <nav2_costmap_2d/costmap_2d.hpp>
#include <nav2_costmap_2d/layered_costmap.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace talus_ros2 {

using nav2_costmap_2d::LETHAL_OBSTACLE;
using nav2_costmap_2d::MAX_NON_OBSTACLE;
using nav2_costmap_2d::NO_INFORMATION;
using talus::maps::CellBox;

namespace {

// Returns the cells of a grid that a square overlaps by more than a rounding error; empty if the square is
// off the grid.
std::optional<CellBox> touched(const talus::maps::Grid& grid, talus::maps::Point middle, double side_m) {
  const double half = std::max(0.5 * side_m / grid.resolution_m - 1e-6, 0.0);
  const double x = (middle.x_m - grid.south_west.x_m) / grid.resolution_m,
               y = (middle.y_m - grid.south_west.y_m) / grid.resolution_m;
  if (!(x + half >= 0.0 && y + half >= 0.0 && x - half < grid.width && y - half < grid.height))
    return std::nullopt;
  const auto cell = [](double at, int cells) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, cells - 1.0));
  };
  return CellBox{{cell(x - half, grid.width), cell(y - half, grid.height)},
                 {cell(x + half, grid.width), cell(y + half, grid.height)}};
}

}  // namespace

void Nav2Layer::onInitialize() {
  const auto node = node_.lock();
  if (!node) throw std::runtime_error(name_ + ": its node is gone");
  enabled_ = parameter(*node, name_ + ".enabled", true);
  refuse_unknown_ = parameter(*node, name_ + ".refuse_unknown", true);
  full_cost_ratio_ = parameter(*node, name_ + ".full_cost_ratio", 20.0);
  if (!(full_cost_ratio_ > 1.0)) throw std::invalid_argument(name_ + ".full_cost_ratio must be > 1");
  map_ = MapNode::shared();
  const std::string frame = layered_costmap_->getGlobalFrameID();
  if (frame != map_->frame())
    throw std::invalid_argument(name_ + ": the costmap's frame is '" + frame + "', talus_map's is '" +
                                map_->frame() + "'; set both to one");
  current_ = true;
}

void Nav2Layer::matchSize() {
  redraw_ = true;
}

void Nav2Layer::reset() {
  redraw_ = true;
  current_ = true;
}

void Nav2Layer::updateBounds(double, double, double, double* min_x, double* min_y, double* max_x,
                             double* max_y) {
  if (!enabled_) return;
  std::vector<CellBox> changed = cells_.show(map_->published());
  const talus::maps::Grid& grid = cells_.version()->grid();
  // A rolling window also brings new cells into view.
  if (redraw_.exchange(false) || layered_costmap_->isRolling())
    changed = {CellBox{{0, 0}, {grid.width - 1, grid.height - 1}}};
  for (const CellBox& box : changed) {
    *min_x = std::min(*min_x, grid.south_west.x_m + box.first.column * grid.resolution_m);
    *min_y = std::min(*min_y, grid.south_west.y_m + box.first.row * grid.resolution_m);
    *max_x = std::max(*max_x, grid.south_west.x_m + (box.last.column + 1) * grid.resolution_m);
    *max_y = std::max(*max_y, grid.south_west.y_m + (box.last.row + 1) * grid.resolution_m);
  }
}

std::uint8_t Nav2Layer::costOf(talus::maps::Cell cell) {
  using Kind = talus::planner::CellJudgement::Kind;
  const talus::planner::CellJudgement judgement = cells_.at(cell);
  if (judgement.kind == Kind::Refused) return LETHAL_OBSTACLE;
  if (judgement.kind == Kind::Restricted) return MAX_NON_OBSTACLE;
  if (judgement.kind == Kind::Unknown) return refuse_unknown_ ? LETHAL_OBSTACLE : NO_INFORMATION;
  const double share = (cells_.costRatio(judgement) - 1.0) / (full_cost_ratio_ - 1.0);
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * (MAX_NON_OBSTACLE - 1)));
}

std::uint8_t Nav2Layer::worstIn(const CellBox& box) {
  std::uint8_t worst = 0;
  bool known = false;
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column) {
      const std::uint8_t cost = costOf({column, row});
      if (cost == NO_INFORMATION) continue;
      known = true;
      worst = std::max(worst, cost);
    }
  return known ? worst : NO_INFORMATION;
}

void Nav2Layer::updateCosts(nav2_costmap_2d::Costmap2D& master, int min_i, int min_j, int max_i, int max_j) {
  if (!enabled_ || !cells_.version()) return;
  unsigned char* costs = master.getCharMap();
  for (int j = min_j; j < max_j; ++j)
    for (int i = min_i; i < max_i; ++i) {
      talus::maps::Point middle;
      const auto column = static_cast<unsigned int>(i), row = static_cast<unsigned int>(j);
      master.mapToWorld(column, row, middle.x_m, middle.y_m);
      const auto box = touched(cells_.version()->grid(), middle, master.getResolution());
      if (!box) continue;
      const std::uint8_t cost = worstIn(*box);
      unsigned char& standing = costs[master.getIndex(column, row)];
      if (cost != NO_INFORMATION && (standing == NO_INFORMATION || standing < cost)) standing = cost;
    }
  current_ = true;
}

}  // namespace talus_ros2

PLUGINLIB_EXPORT_CLASS(talus_ros2::Nav2Layer, nav2_costmap_2d::Layer)
