#pragma once

#include <cstddef>
#include <functional>

#include <talus/maps/grid/grid.hpp>
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
  Polyline points{};          ///< empty where none was found
  bool out_of_reach = false;  ///< whether that is a proof: nothing joins the places, whatever the headings
  std::size_t cells = 0;      ///< then: so many cells some drive from the start may enter
  maps::Point last{};         ///< then: the middle of that of them which is nearest to the goal
  std::size_t ways = 0;       ///< followed
  bool all_ways = false;      ///< whether no way was left out for the limit or a stop
};

/// Some route of any headings between two places, for maps whose only routes the eight headings of the grid miss, or the proof that there is
/// none where Reach, which keeps one part a side only, leaves it open. The straight line where it is allowed, else a way from cell
/// to cell that crosses each side on a heading of both cells and within a cell drives the two allowed headings on both sides of
/// where it has to go, in turns. Not a good route: it is to be refined.
///
/// How (ours). Dijkstra over the sides of cells: a node is a part of a side that is reached in one way; what another way
/// reached before is taken off, so that every part is followed once. The drive through the cells that lead to the goal is laid by laidChain();
/// where that fails, the cell that stopped it is driven on single arcs of headings from then on, and not at all if that fails, too. Where no way leads to the
/// goal, the search is repeated with whole cones, closed sides and corners, which a drive passes over on a heading that all cells
/// around allow: if that does not reach the goal either, nothing does. Parts of less than 1e-9 of a side are rounding there.
CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits = {}, const StopCheck& stop = {});

}  // namespace talus::planner
