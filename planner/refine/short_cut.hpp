#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Replaces stretches of a route by straight motions where cheaper. The ends of motions are piece_m apart
/// along the route; motions over 1, 2, 3, 4, 6, 8, 12... pieces are tried, starting at every eighth of their
/// length, so the work grows as n log n. The best sequence is found by dynamic programming. Ours, not from
/// the literature. Returns the route unchanged when stopped.
Polyline shortCut(const MotionCost& cost, const Polyline& route, double piece_m, const StopCheck& stop = {});

/// Removes points that a straight motion can skip without additional cost.
Polyline withoutIdleTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
