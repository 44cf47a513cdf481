#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Merges adjacent vertices closer than a hundredth of a cell, because the heading between them is
/// meaningless. One vertex of the pair is removed, or both are replaced by their midpoint; of the allowed
/// alternatives the cheapest is used. If none is allowed, the pair remains. The first and last vertex remain.
/// `points` must be allowed.
Polyline withoutCloseVertices(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
