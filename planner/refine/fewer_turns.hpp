#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Returns the cheapest route through some of the vertices of `route` in order, including costs of turns. The
/// first and last vertex remain. The method is dynamic programming over pairs of vertices up to 8 apart. At a
/// turn that `route` does not have, the rover must be allowed on all headings that it passes. Of routes of
/// equal cost, the route with fewer vertices is returned. The result never costs more than `route`; it is
/// `route` itself if no other route is allowed. Ours, not from the literature.
Polyline withFewerTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
