#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The polyline with every vertex between its ends moved, in ever shorter steps, to where the route costs less, turns
/// included: never more expensive. It finds what a search over fixed points only comes near to; a route must be
/// allowed for it to do anything.
Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop = {});

/// The polyline with its end moved along the circle of the tolerance, > 0, around the goal to where the route costs
/// less; never more expensive. One that ends elsewhere stays as it is.
Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m);

/// The polyline with the vertices on sides of cells whose turn both cells do not allow moved just off them, along one
/// of their legs, where that is allowed.
Polyline offSides(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
