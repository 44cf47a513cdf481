#pragma once

#include <vector>

#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// RRT* [karaman_frazzoli_2011] whose tree initially contains a known route, so that all samples improve an
/// existing solution. For states of MapSpace.
class SeededRRTstar : public ompl::geometric::RRTstar {
 public:
  /// Additions to RRT*.
  struct Seed {
    std::vector<maps::Point> route;  ///< start to goal; empty: plain RRT*
    double spacing_m = 1.0;          ///< the route's legs are divided to this length, > 0
    bool informed = false;           ///< sample only where the best cost can be improved [gammell_2014]
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
