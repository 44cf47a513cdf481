#include <stdexcept>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/plan/plan_route.hpp>
#include <talus/planner/plan/route_planner.hpp>
#include <talus/planner/plugin/request_check.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {

Route planRoute(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request,
                const PlannerSettings& settings) {
  return RoutePlanner(settings.planner).plan(map, request, settings);
}

Route planRoute(WindowedMap& map, const PlanRequest& request, const PlannerSettings& settings) {
  const std::string name = plannerName(validated(settings).planner);
  if (name != plannerNames().front())
    throw std::invalid_argument("PlannerSettings: planner '" + name + "' does not plan in windows; use '" +
                                plannerNames().front() + "'");
  requireHonoured(request, {.name = "talus, in windows", .planner = name, .via_points = true});
  Problem problem = problemOf(map.overview(), request, settings);
  const Plan plan = planInWindows(problem, map);
  return checkedRoute(plan, {.map = *problem.map,
                             .elevation_m = [&map](maps::Point p) { return map.elevation_m(p); },
                             .planner = name,
                             .kinematics = problem.kinematics,
                             .watch = request.watch});
}

std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name) {
  auto planner = std::make_unique<OwnPlanner>();
  planner->configure({.planner = name});
  return planner;
}

}  // namespace talus::planner
