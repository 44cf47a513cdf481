#pragma once

#include <memory>

#include <ompl/base/Planner.h>

#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {

/// FieldPlanner as a planner of OMPL, over states of MapSpace: for SimpleSetup, ompl::tools::Benchmark and
/// whatever else takes a planner. It reads the first start state and the goal (a single state, or one with a
/// threshold, which becomes the tolerance), and adds one solution path, exact and with its cost; further
/// starts and goals are left out. The field of a goal is kept until clear().
class FieldOmplPlanner : public ompl::base::Planner {
 public:
  FieldOmplPlanner(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const costmap::CostGrid> map,
                   int threads = 1);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& done) override;
  void clear() override;

 private:
  ompl::base::PathPtr pathOf(const Plan& plan) const;

  std::shared_ptr<const costmap::CostGrid> map_;
  int threads_;
  std::unique_ptr<FieldPlanner> field_;
};

}  // namespace talus::planner
