#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// The route with zigzags gathered: where a stretch tacks, all that leads to the left of the straight line between its ends
/// becomes one leg and all that leads to the right another, in the cheaper order, as far as that is allowed and cheaper, turns
/// priced. From long stretches to short ones, until nothing gets cheaper; the first and last points stay. Ours.
Polyline withLongerTacks(const MotionCost& cost, Polyline route);

}  // namespace talus::planner
