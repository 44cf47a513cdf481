#pragma once

#include <memory>

#include <ompl/base/Planner.h>

#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {

/// Adapter that offers FieldPlanner as a planner of OMPL over states of MapSpace, for SimpleSetup,
/// ompl::tools::Benchmark and similar tools. It uses the first start state and the goal (a single state,
/// whose threshold is the goal tolerance), and adds one solution path with its exact cost. Further start
/// states are ignored; for other types of goals it returns UNRECOGNIZED_GOAL_TYPE. The cost-to-go field of a
/// goal is kept until clear().
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
