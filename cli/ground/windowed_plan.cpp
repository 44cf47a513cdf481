#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/windowed_ground.hpp>
#include <talus/cli/ground/windowed_plan.hpp>
#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/route/legs.hpp>

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
  return planner::planByLegs(problem, [&](const planner::Problem& asked) {
    planner::Problem leg = asked;
    planner::Plan plan = planLeg(leg, ground, tube);
    problem.map = leg.map;
    return plan;
  });
}

}  // namespace talus::cli
