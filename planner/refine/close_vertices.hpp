#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Merges adjacent vertices closer than a hundredth of a cell, whose heading is meaningless: one of the pair
/// is removed, or both are replaced by their midpoint, whichever is cheapest and allowed. The ends of the
/// polyline are kept. A pair stays if no replacement is allowed. `points` must be allowed.
Polyline withoutCloseVertices(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
