#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/route/legs.hpp>

namespace talus::planner {
namespace {

// One leg: along the overview's route, in windows; in wider ones where those hold no way.
Plan planLeg(Problem& leg, WindowedMap& map, TubePlanner& tube) {
  const auto guide = tube.guideOver(map.overview(), leg);
  if (guide.empty()) {
    Plan none;
    none.reason =
        "no route found on the overview; plan on a part with --window, or on the whole map with "
        "--whole-field";
    return none;
  }
  Plan plan;
  for (const double margin_cells : {128.0, 512.0}) {
    leg.map = map.around(guide, margin_cells, leg.watch);
    plan = tube.planAlong(leg, guide);
    if (plan.status != RouteStatus::NoneFound) break;
  }
  return plan;
}

}  // namespace

Plan planInWindows(Problem& problem, WindowedMap& map) {
  TubePlanner tube;
  Plan whole = planByLegs(problem, [&](const Problem& asked) {
    Problem leg = asked;
    Plan plan = planLeg(leg, map, tube);
    problem.map = leg.map;
    return plan;
  });
  whole.interrupted = problem.watch.stopped();
  return whole;
}

}  // namespace talus::planner
