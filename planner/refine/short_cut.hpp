#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The route with stretches replaced by straight motions wherever that is cheaper. Ends of motions lie
/// piece_m apart along the route; tried are motions over 1, 2, 3, 4, 6, 8, 12... pieces that begin at every
/// eighth of their length, so that the work grows as n log n; the best sequence of them by dynamic
/// programming. Ours. The route itself when stopped.
Polyline shortCut(const MotionCost& cost, const Polyline& route, double piece_m, const StopCheck& stop = {});

/// The same route without the points that a straight motion can leave out at no cost.
Polyline withoutIdleTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
