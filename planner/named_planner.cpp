#include <planner/named_planner.hpp>
#include <planner/planner_names.hpp>

namespace talus::planner {

NamedPlanner::NamedPlanner(const std::string& name) {
  settings_.planner = plannerName(name);
}

Plan NamedPlanner::plan(const Problem& problem) {
  if (settings_.planner == plannerNames().front()) return field_.plan(problem);
  if (drives()) return drive_.plan(problem);
  return planBySampling(problem, settings_, [this](const Problem& leg) {
    return LegKnowledge{.plan = field_.plan(leg), .from_start = {}, .to_goal = {}};
  });
}

}  // namespace talus::planner
