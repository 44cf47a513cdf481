#pragma once

#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Merges adjacent vertices closer than a hundredth of a cell, because the heading between them is
/// meaningless. One vertex of the pair is removed, or both are replaced by their midpoint; of the allowed
/// alternatives the cheapest is used. If none is allowed, the pair remains. The first and last vertex remain.
/// `points` must be allowed.
Polyline withoutCloseVertices(const MotionCost& cost, Polyline points);

/// Returns the cheapest route through some of the vertices of `route` in order, including costs of turns. The
/// first and last vertex remain. The method is dynamic programming over pairs of vertices up to 8 apart. At a
/// turn that `route` does not have, the rover must be allowed on all headings that it passes. Of routes of
/// equal cost, the route with fewer vertices is returned. The result never costs more than `route`; it is
/// `route` itself if no other route is allowed. Ours, not from the literature.
Polyline withFewerTurns(const MotionCost& cost, const Polyline& route);

/// Merges zigzags of a route. In a section of the route, all legs to the left of the straight line between
/// the ends of the section become one leg, and all other legs become another leg, in the cheaper order. The
/// replacement is made if it is allowed and cheaper, including costs of turns. Sections are processed from
/// long to short, and this is repeated until the cost no longer decreases, at most six times. The first and
/// last vertex remain. Ours, not from the literature.
Polyline withLongerTacks(const MotionCost& cost, Polyline route);

/// Moves the vertices with the indices `vertices`, or every vertex except the first and the last if there are
/// none, in decreasing steps, to positions at which the route costs less, including costs of turns. The cost
/// never increases. The function improves routes of searches over fixed points. A route that is not allowed is
/// returned unchanged.
Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop = {},
                             std::vector<std::size_t> vertices = {});

/// Moves the last vertex along the circle with the radius `tolerance_m` > 0 around the goal to a position at
/// which the route costs less. The cost never increases. A route that does not end on the circle is returned
/// unchanged.
Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m);

/// Moves a vertex on a cell side off this side if the adjacent cells do not allow the turn there. The vertex
/// moves slightly along one of its legs, or their extensions, to a position at which the turn is allowed.
Polyline offSides(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
