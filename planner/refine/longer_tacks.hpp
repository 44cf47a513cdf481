#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Merges zigzags: within a stretch, all legs to the left of the straight line between its ends become one
/// leg and all other legs another, in the cheaper order, if allowed and cheaper including turns. From long
/// stretches to short ones, repeated until the cost no longer decreases or six rounds are done; first and
/// last point are kept. Ours, not from the literature.
Polyline withLongerTacks(const MotionCost& cost, Polyline route);

}  // namespace talus::planner
