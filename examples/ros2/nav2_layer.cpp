#include "nav2_layer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include <nav2_costmap_2d/cost_values.hpp>
#include <nav2_costmap_2d/costmap_2d.hpp>
#include <nav2_costmap_2d/layered_costmap.hpp>

namespace talus_ros2 {

using nav2_costmap_2d::LETHAL_OBSTACLE;
using nav2_costmap_2d::MAX_NON_OBSTACLE;
using nav2_costmap_2d::NO_INFORMATION;
using talus::costmap::CellCode;
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

Nav2Layer::~Nav2Layer() = default;

void Nav2Layer::onInitialize() {
  const auto node = node_.lock();
  if (!node) throw std::runtime_error(name_ + ": its node is gone");
  enabled_ = parameter(*node, name_ + ".enabled", true);
  refuse_unknown_ = parameter(*node, name_ + ".refuse_unknown", true);
  full_cost_ratio_ = parameter(*node, name_ + ".full_cost_ratio", 20.0);
  if (!(full_cost_ratio_ > 1.0)) throw std::invalid_argument(name_ + ".full_cost_ratio must be > 1");
  map_ = patchedMap(*node, name_, layered_costmap_->getGlobalFrameID());
  subscription_ = patchedByTopic(node, name_, *map_, callback_group_);
  current_ = true;
}

void Nav2Layer::matchSize() {
  redraw_ = true;
}

void Nav2Layer::reset() {
  redraw_ = true;
  current_ = true;
}

// Unchanged tiles are shared between versions.
std::vector<CellBox> Nav2Layer::changedSince(const Version& before) const {
  constexpr int kSide = talus::costmap::CostTile::kSide;
  const talus::maps::Grid& grid = now_->grid();
  if (!before || before->content().cost != now_->content().cost)
    return {CellBox{{0, 0}, {grid.width - 1, grid.height - 1}}};
  std::vector<CellBox> changed;
  for (std::size_t i = 0; i < now_->content().tiles.size(); ++i) {
    if (now_->content().tiles[i] == before->content().tiles[i]) continue;
    const int column = static_cast<int>(i) % now_->tileColumns() * kSide,
              row = static_cast<int>(i) / now_->tileColumns() * kSide;
    changed.push_back({{column, row}, {column + kSide - 1, row + kSide - 1}});
  }
  return changed;
}

void Nav2Layer::updateBounds(double, double, double, double* min_x, double* min_y, double* max_x,
                             double* max_y) {
  if (!enabled_) return;
  const Version before = std::exchange(now_, map_->published());
  if (!before || before->content().cost != now_->content().cost) {
    judge_ = std::make_unique<talus::planner::CellJudge>(now_->content().cost);
    cells_.assign(now_->grid().size(), {CellCode(), refuse_unknown_ ? LETHAL_OBSTACLE : NO_INFORMATION});
  }
  // A rolling window also brings new cells into view.
  const bool all = redraw_.exchange(false) || layered_costmap_->isRolling();
  const talus::maps::Grid& grid = now_->grid();
  for (const CellBox& box : changedSince(all ? nullptr : before)) {
    *min_x = std::min(*min_x, grid.south_west.x_m + box.first.column * grid.resolution_m);
    *min_y = std::min(*min_y, grid.south_west.y_m + box.first.row * grid.resolution_m);
    *max_x = std::max(*max_x, grid.south_west.x_m + (box.last.column + 1) * grid.resolution_m);
    *max_y = std::max(*max_y, grid.south_west.y_m + (box.last.row + 1) * grid.resolution_m);
  }
}

std::uint8_t Nav2Layer::judged(talus::maps::Cell cell) {
  using Kind = talus::planner::CellJudgement::Kind;
  Judged& known = cells_[now_->grid().index(cell)];
  const CellCode code = now_->at(cell);
  if (known.code == code) return known.cost;
  const talus::planner::CellJudgement judgement = judge_->of(code);
  known.code = code;
  if (judgement.kind == Kind::Refused) return known.cost = LETHAL_OBSTACLE;
  if (judgement.kind == Kind::Restricted) return known.cost = MAX_NON_OBSTACLE;
  if (judgement.kind == Kind::Unknown) return known.cost = refuse_unknown_ ? LETHAL_OBSTACLE : NO_INFORMATION;
  const double dearer = static_cast<double>(judgement.highest_J_per_m / judge_->level_J_per_m() - 1.0F);
  const double share = std::clamp(dearer / (full_cost_ratio_ - 1.0), 0.0, 1.0);
  return known.cost = static_cast<std::uint8_t>(std::lround(share * (MAX_NON_OBSTACLE - 1)));
}

std::uint8_t Nav2Layer::worstIn(const CellBox& box) {
  std::uint8_t worst = 0;
  bool known = false;
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column) {
      const std::uint8_t cost = judged({column, row});
      if (cost == NO_INFORMATION) continue;
      known = true;
      worst = std::max(worst, cost);
    }
  return known ? worst : NO_INFORMATION;
}

void Nav2Layer::updateCosts(nav2_costmap_2d::Costmap2D& master, int min_i, int min_j, int max_i, int max_j) {
  if (!enabled_ || !now_) return;
  unsigned char* costs = master.getCharMap();
  for (int j = min_j; j < max_j; ++j)
    for (int i = min_i; i < max_i; ++i) {
      talus::maps::Point middle;
      const auto column = static_cast<unsigned int>(i), row = static_cast<unsigned int>(j);
      master.mapToWorld(column, row, middle.x_m, middle.y_m);
      const auto box = touched(now_->grid(), middle, master.getResolution());
      if (!box) continue;
      const std::uint8_t cost = worstIn(*box);
      unsigned char& standing = costs[master.getIndex(column, row)];
      if (cost != NO_INFORMATION && (standing == NO_INFORMATION || standing < cost)) standing = cost;
    }
  current_ = true;
}

}  // namespace talus_ros2
