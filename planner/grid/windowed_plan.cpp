#include <algorithm>
#include <utility>

#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {
namespace {

// Clamps the guide to the map: cells of the overview may extend beyond the map.
Polyline onto(const maps::Grid& grid, Polyline guide) {
  const double half_m = 0.5 * grid.resolution_m;
  const maps::Point low{grid.south_west.x_m + half_m, grid.south_west.y_m + half_m};
  for (maps::Point& p : guide)
    p = {std::clamp(p.x_m, low.x_m, low.x_m + (grid.width - 1) * grid.resolution_m),
         std::clamp(p.y_m, low.y_m, low.y_m + (grid.height - 1) * grid.resolution_m)};
  return guide;
}

// Plans one leg along the overview's route in a window, then in a wider window if the first contains no
// route.
Plan planLeg(Problem& leg, WindowedMap& map, TubePlanner& tube) {
  const auto guide = onto(map.grid(), tube.guideOver(map.overview(), leg));
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
