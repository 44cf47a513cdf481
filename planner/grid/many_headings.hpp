#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The cheapest way between two places from centre to centre of cells in 32 headings, at most 18.4 degrees apart: where crossing a slope
/// is priced, eight headings miss corridors that need another. To be refined. Dijkstra's search under the exact cost of each leg,
/// turns left out; ways of `most_J` and more are not followed. Empty where there is none cheaper, or when stopped.
Polyline manyHeadingsRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                           const StopCheck& stop = {});

}  // namespace talus::planner
