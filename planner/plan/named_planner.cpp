#include <talus/planner/grid/goal_choice.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {

NamedPlanner::NamedPlanner(const std::string& name) {
  settings_ = samplingSettings(name);
}

Plan NamedPlanner::planField(const Problem& problem) {
  const bool large = problem.map && problem.map->grid().size() > kLarge;
  return large && !problem.whole_field ? tube_.plan(problem) : field_.plan(problem);
}

Plan NamedPlanner::plan(const Problem& problem) {
  Plan plan = problem.other_goals.empty()
                  ? planOne(problem)
                  : planToCheapest(problem, [this](const Problem& one_goal) { return planOne(one_goal); });
  plan.interrupted = problem.watch.stopped();
  return plan;
}

Plan NamedPlanner::planOne(const Problem& problem) {
  if (settings_.planner == plannerNames().front()) return planField(problem);
  if (drives()) return drive_.plan(problem);
  const auto field = [this](const Problem& leg) { return planField(leg); };
  return planBySampling(problem, settings_, settings_.cold ? InitialPathProvider() : field);
}

}  // namespace talus::planner
