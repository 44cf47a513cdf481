#pragma once

#include <talus/cli/draw/scene.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::cli {

/// A start and a goal without a feasible route between them.
struct Severed {
  /// Start and goal.
  planner::Segment places;
  double tolerance_m = 0.0;  ///< accepted distance of the end of a route from the goal
  std::string reason;        ///< reason for which there is no route, in one line
};

/// Returns the scene of a request without a feasible route. The first layer has two classes: cells that can
/// be reached from the start, and cells from which the goal can be reached; other cells have no value. A ring
/// marks the smaller of the two sets, and the title ends with the reason. The cost grid must be that of the
/// map.
Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options);

}  // namespace talus::cli
