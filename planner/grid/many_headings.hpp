#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns the cheapest route from `places.from` to `places.to`, or to within `tolerance_m` of it. The legs
/// lead from cell centre to cell centre in 32 headings, at most 18.4 degrees apart. If driving across a slope
/// has a cost, a search in eight headings misses corridors that require another heading. The route is meant
/// to be refined. The method is Dijkstra's algorithm with the exact cost of each leg; costs of turns are not
/// included. Routes that cost `most_J` [J] or more are not searched. The result is empty if there is no
/// cheaper route, or after a stop.
Polyline manyHeadingsRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                           const StopCheck& stop = {});

}  // namespace talus::planner
