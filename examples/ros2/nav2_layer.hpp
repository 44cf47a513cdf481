// Shows   traversability as a layer of Nav2's 2D costmap, for planners and controllers without headings.
// Needs   map_node.hpp, nav2_costmap_2d (Jazzy or later).  Parameters: README.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include <nav2_costmap_2d/layer.hpp>

#include "map_node.hpp"

namespace talus_ros2 {

/// Costmap layer of Nav2: a view of the map of MapNode. The layer writes the maximum of the existing
/// cost and its own cost of a cell. Its own cost is lethal if no heading is allowed, 252 (the highest cost of
/// a cell without obstacle) if some headings are not allowed, otherwise a value that increases with the cost
/// of the most expensive heading. An unobserved cell is lethal or without information, as set by a parameter.
/// Cells outside the Talus map are unchanged. The costmap calls the layer in one thread.
class Nav2Layer : public nav2_costmap_2d::Layer {
 public:
  void onInitialize() override;
  void updateBounds(double robot_x, double robot_y, double robot_yaw, double* min_x, double* min_y,
                    double* max_x, double* max_y) override;
  void updateCosts(nav2_costmap_2d::Costmap2D& master, int min_i, int min_j, int max_i, int max_j) override;
  void matchSize() override;
  void reset() override;
  bool isClearable() override { return false; }

 private:
  std::uint8_t costOf(talus::maps::Cell cell);
  std::uint8_t worstIn(const talus::maps::CellBox& box);

  std::shared_ptr<MapNode> map_;
  JudgedCells cells_;
  double full_cost_ratio_ = 20.0;
  bool refuse_unknown_ = true;
  std::atomic<bool> redraw_ = true;  // true: the next update draws all cells
};

}  // namespace talus_ros2
