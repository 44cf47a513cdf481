#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Cheapest route between two places over fixed points of cells: 7 points on each side, and 9 points inside
/// cells that refuse some heading, so that a route can tack there. Maps of more than 20,000 cells use 3 and 1
/// points; maps of up to 1,000 cells use 15 and 25, as do maps of up to 5,000 cells if no route was found. A
/// leg crosses one cell or a section of a cell at its exact cost. The cost of a turn at a point depends on
/// the cheapest leg that reaches the point. Finds corridors that grids of few headings miss, especially where
/// cells allow few headings; the route is meant to be refined. A* search with a straight-line lower bound;
/// routes of cost `most_J` [J] or more are not followed. Empty if no cheaper route exists, or when stopped.
Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop = {});

}  // namespace talus::planner
