#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Replaces sections of a route by straight motions where these are cheaper. Possible ends of motions are
/// `piece_m` apart along the route. Motions over 1, 2, 3, 4, 6, 8, 12... pieces are tried, starting at every
/// eighth of their length; therefore the time grows as n log n for n pieces. The best sequence of motions is
/// found by dynamic programming. Ours, not from the literature. After a stop, the route is returned
/// unchanged.
Polyline shortCut(const MotionCost& cost, const Polyline& route, double piece_m, const StopCheck& stop = {});

/// Removes a vertex if the straight motion between its neighbours is not more expensive.
Polyline withoutIdleTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
