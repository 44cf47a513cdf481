#pragma once

#include <talus/cli/draw/scene.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::cli {

/// What is known of two places that nothing connects.
struct Severed {
  planner::Segment places;
  double tolerance_m = 0.0;  ///< of the goal
  std::string reason;        ///< one line
};

/// A map whose first layer has two classes: the cells that a drive from the start may reach, and those that lead to the goal;
/// the others have no value. A ring marks the smaller set, and the title ends with the reason. The cost grid is that of the map.
Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options);

}  // namespace talus::cli
