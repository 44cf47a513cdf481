#pragma once

#include <talus/cli/draw/scene.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::cli {

/// Two places without a connection.
struct Severed {
  planner::Segment places;
  double tolerance_m = 0.0;  ///< tolerance of the goal
  std::string reason;        ///< reason in one line
};

/// Scene of an infeasible request. The first layer has two classes: cells reachable from the start, and cells
/// from which the goal is reachable; other cells have no value. A ring marks the smaller set, and the title
/// ends with the reason. The cost grid must be that of the map.
Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options);

}  // namespace talus::cli
