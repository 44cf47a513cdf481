#include <cli/context.hpp>
#include <cli/windowed_ground.hpp>
#include <cli/windowed_plan.hpp>
#include <planner/tube_planner.hpp>

namespace talus::cli {
namespace {

// One leg: along the overview's route, in windows; in wider ones where those hold no way.
planner::Plan planLeg(planner::Problem& leg, WindowedGround& ground, planner::TubePlanner& tube) {
  const auto guide = tube.guideOver(ground.overview().map.published(), leg);
  if (guide.empty()) {
    planner::Plan none;
    none.reason =
        "the overview shows no way; plan on a part with --window, or on the whole with --whole-field";
    return none;
  }
  planner::Plan plan;
  for (const double margin_cells : {128.0, 512.0}) {
    leg.map = ground.around(guide, margin_cells);
    plan = tube.planAlong(leg, guide);
    if (plan.status != planner::RouteStatus::NoRoute) break;
  }
  return plan;
}

}  // namespace

planner::Plan planInWindows(planner::Problem& problem, WindowedGround& ground) {
  planner::TubePlanner tube;
  auto stops = problem.via;
  stops.push_back(problem.goal);
  planner::Plan whole{planner::RouteStatus::Found, {}, {problem.start}, 0.0, 0.0};
  for (std::size_t k = 0; k < stops.size(); ++k) {
    planner::Problem leg = problem;
    leg.via.clear();
    leg.start = whole.points.back();
    leg.goal = stops[k];
    if (k + 1 < stops.size()) leg.goal_tolerance_m = 0.0;
    planner::Plan part = planLeg(leg, ground, tube);
    problem.map = leg.map;
    if (part.status != planner::RouteStatus::Found) return part;
    planner::append(whole.points, part.points);
    whole.cost_J += part.cost_J;
    whole.lower_bound_J += part.lower_bound_J;
  }
  return whole;
}

}  // namespace talus::cli
