// Shows   traversability as a layer of Nav2's 2D costmap, for planners and controllers without headings.
// Needs   talus::planner, nav2_costmap_2d (Jazzy or later), grid_map_core, grid_map_msgs. README.md lists the
//         parameters.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <nav2_costmap_2d/layer.hpp>

#include "patched_map.hpp"

namespace talus_ros2 {

/// Costmap layer of Nav2 with the traversability of a Talus map. The layer writes the maximum of the existing
/// cost and its own cost of a cell. Its own cost is lethal if no heading is allowed, 252 (the highest cost of
/// a cell without obstacle) if some headings are not allowed, otherwise a value that increases with the cost
/// of the most expensive heading. An unobserved cell is lethal or without information, as set by a parameter.
/// Cells outside the Talus map are unchanged. The costmap calls the layer in one thread; the subscription may
/// run in another thread.
class Nav2Layer : public nav2_costmap_2d::Layer {
 public:
  ~Nav2Layer() override;
  void onInitialize() override;
  void updateBounds(double robot_x, double robot_y, double robot_yaw, double* min_x, double* min_y,
                    double* max_x, double* max_y) override;
  void updateCosts(nav2_costmap_2d::Costmap2D& master, int min_i, int min_j, int max_i, int max_j) override;
  void matchSize() override;
  void reset() override;
  bool isClearable() override { return false; }

 private:
  using Version = std::shared_ptr<const talus::costmap::CostGrid>;

  std::vector<talus::maps::CellBox> changedSince(const Version& before) const;
  std::uint8_t judged(talus::maps::Cell cell);
  std::uint8_t worstIn(const talus::maps::CellBox& box);

  std::unique_ptr<PatchedMap> map_;
  std::shared_ptr<void> subscription_;  // uses map_
  double full_cost_ratio_ = 20.0;
  bool refuse_unknown_ = true;
  std::atomic<bool> redraw_ = true;  // true: the next update draws all cells
  Version now_;                      // map version drawn last
  // Cost of a cell, and the cell code from which the cost was computed.
  struct Judged {
    talus::costmap::CellCode code;
    std::uint8_t cost;
  };
  std::unique_ptr<talus::planner::CellJudge> judge_;
  std::vector<Judged> cells_;
};

}  // namespace talus_ros2
