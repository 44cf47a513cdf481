#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Merges zigzags of a route. In a section of the route, all legs to the left of the straight line between
/// the ends of the section become one leg, and all other legs become another leg, in the cheaper order. The
/// replacement is made if it is allowed and cheaper, including costs of turns. Sections are processed from
/// long to short, and this is repeated until the cost no longer decreases, at most six times. The first and
/// last vertex remain. Ours, not from the literature.
Polyline withLongerTacks(const MotionCost& cost, Polyline route);

}  // namespace talus::planner
