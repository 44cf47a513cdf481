#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Moves every inner vertex, in decreasing steps, to positions where the route costs less, including turns.
/// Never increases the cost. Improves routes of searches over fixed points. A route that is not allowed is
/// returned unchanged.
Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop = {});

/// Moves the end along the circle of the tolerance, > 0, around the goal to where the route costs less. Never
/// increases the cost. A route that does not end on the circle is returned unchanged.
Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m);

/// Moves vertices on cell sides at which the adjacent cells do not allow the turn slightly off the side,
/// along one of their legs, if allowed there.
Polyline offSides(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
