#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Cheapest route through some of the points in order, including turn costs; first and last point are kept.
/// Dynamic programming over pairs of points up to 8 apart. A turn that the given route does not have must
/// pass allowed headings only. Of routes of equal cost, the route with fewer points is returned. Never costs
/// more than the given route; returns the given route if no other is allowed. Ours, not from the literature.
Polyline withFewerTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
