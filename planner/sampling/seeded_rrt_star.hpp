#pragma once

#include <vector>

#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// RRT* [karaman_frazzoli_2011] with a tree that initially contains a known route, so that all samples
/// improve an existing solution. For states of MapSpace.
class SeededRRTstar : public ompl::geometric::RRTstar {
 public:
  /// Parameters in addition to those of RRT*.
  struct Seed {
    std::vector<maps::Point> route;  ///< known route from start to goal; empty: RRT* without a known route
    double spacing_m = 1.0;  ///< length of the parts into which the legs of the route are divided, > 0
    bool informed = false;   ///< true: sample only where the best cost can be reduced [gammell_2014]
  };

  SeededRRTstar(const ompl::base::SpaceInformationPtr& space, Seed seed);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& done) override;

 private:
  void plant();
  Motion* plantRoot();
  Motion* grow(Motion* parent, maps::Point place);

  Seed seed_;
};

}  // namespace talus::planner
