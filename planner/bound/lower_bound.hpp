#pragma once

#include <memory>
#include <optional>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// No motion of any shape from the one place to within the tolerance of the other costs less: the distance at
/// the cheapest metre of any ground.
double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m = 0.0);

/// What no route to a goal costs less than, whatever its shape and headings: the field over admissibleEdges(),
/// or straightBound_J() where that is higher. Kept for a map and a goal, so that another start is answered at
/// once.
class LowerBound {
 public:
  /// Joules, >= 0; the straight bound alone when stopped.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {});

 private:
  std::shared_ptr<const costmap::CostGrid> map_;
  std::shared_ptr<const EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  maps::Point goal_;
  double tolerance_m_ = 0.0;
};

}  // namespace talus::planner
