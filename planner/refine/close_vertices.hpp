#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// The polyline with no two vertices nearer than a hundredth of a cell, whose heading would mean nothing: of such a pair one
/// is dropped or both become the point between them, whichever is cheapest and allowed; ends stay. A pair of which none of
/// this is allowed stays. The polyline given must be allowed.
Polyline withoutCloseVertices(const MotionCost& cost, Polyline points);

}  // namespace talus::planner
