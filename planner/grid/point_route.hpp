#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The cheapest way between two places over fixed points of cells: seven of each side, and nine within cells that
/// refuse some heading, so that a way may tack there; three and one on maps of more than 20,000 cells; more where
/// they find nothing on those of up to 5,000. A leg crosses one cell, or a part of it, under its exact cost; each
/// turn is paid as the cheapest way to it came there. It finds corridors that grids of few headings miss, above all
/// where cells allow few headings; to be refined. Dijkstra's search; ways of `most_J` and more are not followed.
/// Empty where there is none cheaper, or when stopped.
Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop = {});

}  // namespace talus::planner
