#pragma once

#include <vector>

#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// RRT* [karaman_frazzoli_2011] whose tree begins with a route known already, so that it has a solution from
/// the first moment and spends its samples on improving it. States of MapSpace.
class SeededRRTstar : public ompl::geometric::RRTstar {
 public:
  /// What differs from RRT*.
  struct Seed {
    std::vector<maps::Point> route;  ///< start to goal; empty: plain RRT*
    double spacing_m = 1.0;          ///< the route's legs are cut to this length, > 0
    bool informed = false;           ///< sample only where the best cost can be beaten [gammell_2014]
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
