#pragma once

#include <talus/planner/refine/point_search.hpp>

namespace talus::planner {

/// Returns the cheapest route from `places.from` to `places.to`, or to within `tolerance_m` of it, over points
/// of the cells of the map (PointSearch): 7 on each side and 9 inside each cell that does not permit some
/// heading. Maps of more than 20,000 cells have 3 and 1 points; maps of up to 1,000 cells have 15 and 25. With `more`,
/// the greater numbers of points follow instead until a route is found, as far as the map permits. The search finds
/// corridors that grids with few headings miss, especially where cells permit few headings; the route is meant
/// to be refined. The estimate of A* is `rest`, or a straight-line lower bound without it. Routes that cost
/// `most_J` [J] or more are not searched. The result is empty if there is no cheaper route, or after a stop.
Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop = {}, const Rest& rest = {}, bool more = false);

}  // namespace talus::planner
