#include <stdexcept>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/plugin/own_planner.hpp>
#include <talus/planner/plugin/request_check.hpp>
#include <talus/planner/plugin/windowed_route.hpp>
#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {

Route routeInWindows(const PlanRequest& request, WindowedMap& map, const PlannerSettings& settings) {
  const std::string name = plannerName(validated(settings).planner);
  if (name != plannerNames().front())
    throw std::invalid_argument("PlannerSettings: planner '" + name + "' does not plan in windows; use '" +
                                plannerNames().front() + "'");
  requireHonoured(request, {.name = "talus, in windows", .planner = name, .via_points = true});
  Problem problem{.map = map.overview(),
                  .start = request.start,
                  .goal = request.goal,
                  .goal_tolerance_m = request.tolerance_m,
                  .via = request.via,
                  .time_limit_s = settings.time_limit_s,
                  .seed = settings.seed,
                  .threads = settings.threads,
                  .watch = request.watch};
  const Plan plan = checkedPlan(planInWindows(problem, map), *problem.map, 0.0);
  return annotated(plan, {.map = *problem.map,
                          .elevation_m = [&map](maps::Point p) { return map.elevation_m(p); },
                          .planner = name});
}

}  // namespace talus::planner
