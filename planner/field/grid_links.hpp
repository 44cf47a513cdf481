#pragma once

#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Cell whose centre is connected to a place by one allowed straight motion.
struct GridLink {
  maps::Cell cell;
  double cost_J = 0.0;
};

/// Links to the centres of the cell of a place and its eight neighbours that can be reached from the place.
std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place);

/// Links from the centres of the cell of a place and its eight neighbours from which the place can be
/// reached.
std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place);

/// Goals of a field for this goal: linksTo(), plus every allowed cell whose centre lies within the tolerance,
/// at cost 0.
std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m);

}  // namespace talus::planner
