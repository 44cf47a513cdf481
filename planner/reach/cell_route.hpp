#pragma once

#include <cstddef>
#include <functional>

#include <talus/maps/grid.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// What cellRoute() may do: both limits are counts, so that the answer does not depend on the machine.
struct CellRouteLimits {
  /// Ways into a cell that are followed, some 2 us each.
  std::size_t ways = 4'000'000;
  /// Where a way may pass; everywhere if empty. Cells from which the goal is out of reach only cost work.
  std::function<bool(maps::Cell)> worth{};
};

/// What cellRoute() found.
struct CellRoute {
  Polyline points{};      ///< empty where none was found, which proves nothing (Reach does)
  std::size_t ways = 0;   ///< followed
  bool all_ways = false;  ///< whether no way was left out for the limit or a stop
};

/// Some route of any headings between two places, for maps whose only routes the eight headings of the grid miss: the
/// straight line where it is allowed, else a way from cell to cell that crosses each side on a heading of both cells and
/// within a cell drives the two allowed headings on both sides of where it has to go, in turns. Not a good route: it is
/// to be refined.
///
/// How (ours). Dijkstra over the sides of cells: a node is a part of a side that is reached in one way, as Reach has them
/// but not joined; the route is laid backwards from the goal, through a place of each part from which the next is reached.
CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits = {}, const StopCheck& stop = {});

}  // namespace talus::planner
