#pragma once

#include <cstddef>
#include <functional>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Limits of cellRoute(). Both are independent of run time, so that results do not depend on the machine.
struct CellRouteLimits {
  /// Largest number of expanded entries into cells, about 2 us each.
  std::size_t ways = 4'000'000;
  /// Cells that a path may enter; all cells if empty. Excluding cells from which the goal is out of reach
  /// saves work.
  std::function<bool(maps::Cell)> may_enter{};
};

/// Result of cellRoute().
struct CellRoute {
  Polyline points{};          ///< empty if no route was found
  bool out_of_reach = false;  ///< true if proven that no route exists with any headings
  std::size_t cells = 0;      ///< if out_of_reach: number of cells reachable from the start
  maps::Point last{};         ///< if out_of_reach: centre of the reachable cell nearest to the goal
  std::size_t ways = 0;       ///< number of expanded entries
  bool all_ways = false;      ///< false if a limit or a stop ended the search
};

/// Finds a route with arbitrary headings between two places, or proves that none exists. Used on maps whose
/// only routes are not on the eight grid headings, and where Reach, which stores one range per side, is
/// undecided. Returns the straight line if permitted. Otherwise the route passes from cell to cell, crosses
/// each side with a heading permitted in both cells, and inside a cell alternates between the permitted
/// headings on both sides of the required direction. The route is not optimal and must be refined.
///
/// Method (ours). Dijkstra's algorithm over the sides of cells: a node is a range of a side reached by one
/// path; ranges reached before are removed, so that each range is expanded once. laidChain() constructs the
/// drive through the cells that lead to the goal. If the construction fails, the blocking cell is restricted
/// to single arcs of headings, and excluded if the construction fails again. If no path leads to the goal,
/// the search is repeated with complete cones and closed sides, and with corners, which a drive may pass on a
/// heading permitted in all cells around. If this search does not reach the goal either, no route exists.
/// Ranges below 1e-9 of a side are treated as rounding in this search.
CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits = {}, const StopCheck& stop = {});

}  // namespace talus::planner
