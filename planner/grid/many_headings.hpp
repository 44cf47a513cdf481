#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Cheapest route between two places from cell centre to cell centre in 32 headings, at most 18.4 degrees
/// apart. If cross-slope driving has a cost, eight headings miss corridors that need another heading. The
/// route is meant to be refined. Dijkstra's algorithm with the exact cost of each leg; turn costs are not
/// included. Routes of cost `most_J` [J] or more are not followed. Empty if no cheaper route exists, or when
/// stopped.
Polyline manyHeadingsRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                           const StopCheck& stop = {});

}  // namespace talus::planner
