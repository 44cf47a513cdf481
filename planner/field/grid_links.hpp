#pragma once

#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Link of a point to the grid: a cell, and the cost of the straight motion between the point and the cell
/// centre.
struct GridLink {
  maps::Cell cell;
  double cost_J = 0.0;
};

/// Returns the links from `place` to the centres of its cell and of the eight neighbours of this cell, for
/// the straight motions that are allowed.
std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place);

/// Returns the links to `place` from the centres of its cell and of the eight neighbours of this cell, for
/// the straight motions that are allowed.
std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place);

/// Returns the goals of the cost-to-go field for `goal`: the cells of linksTo(), and every cell that allows
/// some heading and has its centre within the tolerance of the goal, with remaining cost 0.
std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m);

}  // namespace talus::planner
