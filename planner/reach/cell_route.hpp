#pragma once

#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Some route of any headings between two places, for maps whose only routes the eight headings of the grid miss: the
/// straight line where it is allowed, else a way from cell to cell that crosses each side on a heading of both cells and
/// within a cell drives the two allowed headings on both sides of where it has to go, in turns. Not a good route: it is
/// to be refined. Empty where none was found, which proves nothing (Reach does), or when stopped.
///
/// How (ours). Dijkstra over the sides of cells: a node is a part of a side that is reached in one way, as Reach has them
/// but not joined; the route is laid backwards from the goal, through a place of each part from which the next is reached.
Polyline cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                   const StopCheck& stop = {});

}  // namespace talus::planner
