#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Moves every vertex except the first and the last, in decreasing steps, to positions at which the route
/// costs less, including costs of turns. The cost never increases. The function improves routes of searches
/// over fixed points. A route that is not allowed is returned unchanged.
Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop = {});

/// Moves the last vertex along the circle with the radius `tolerance_m` > 0 around the goal to a position at
/// which the route costs less. The cost never increases. A route that does not end on the circle is returned
/// unchanged.
Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m);

/// Moves a vertex on a cell side off this side if the adjacent cells do not allow the turn there. The vertex
/// moves slightly along one of its legs, or their extensions, to a position at which the turn is allowed.
Polyline offSides(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
