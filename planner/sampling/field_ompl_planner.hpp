#pragma once

#include <memory>

#include <ompl/base/Planner.h>

#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {

/// FieldPlanner as an OMPL planner over states of MapSpace, for SimpleSetup, ompl::tools::Benchmark and
/// similar tools. Uses the first start state and the goal (a single state; its threshold is the goal
/// tolerance), and adds one exact solution path with its cost. Further start states are ignored; other goal
/// types return UNRECOGNIZED_GOAL_TYPE. The field of a goal is cached until clear().
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
