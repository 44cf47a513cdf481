#pragma once

#include <vector>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// A cell whose centre a place is joined to by one allowed straight motion.
struct GridLink {
  maps::Cell cell;
  double cost_J = 0.0;
};

/// The cells around a place, its own among them, whose centres can be driven to from it.
std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place);

/// The cells around a place, its own among them, from whose centres it can be driven to.
std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place);

/// Where a field to this goal begins: linksTo(), and at no cost every cell whose centre lies within the
/// tolerance.
std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m);

}  // namespace talus::planner
