#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Union of the ranges of one side of a cell that were reached so far, called the covered part.
class SideCover {
 public:
  /// Returns the parts of `range` that are longer than `least` [cell sides, >= 0] and not covered yet, and
  /// adds them to the covered part. Shorter parts are not added; therefore several short parts are returned
  /// once their total length exceeds `least`.
  std::vector<SideRange> added(const SideRange& range, double least) {
    std::vector<SideRange> fresh;
    double at = range.from;
    for (const SideRange& part : parts_) {
      if (part.to < at) continue;
      if (part.from >= range.to) break;
      if (part.from - at > least) fresh.push_back({at, part.from});
      at = part.to;
    }
    if (range.to - at > least) fresh.push_back({at, range.to});
    for (const SideRange& part : fresh) cover(part);
    return fresh;
  }

 private:
  void cover(SideRange range) {
    const auto touches = [](const SideRange& part, const SideRange& other) {
      return part.to >= other.from && part.from <= other.to;
    };
    const auto first =
        std::ranges::find_if(parts_, [&](const SideRange& part) { return part.to >= range.from; });
    auto end = first;
    for (; end != parts_.end() && touches(*end, range); ++end) range = range.hull(*end);
    parts_.insert(parts_.erase(first, end), range);
  }

  std::vector<SideRange> parts_;  // sorted, disjoint
};

/// Limits of cellRoute(). They do not depend on the computing time; therefore results do not depend on the
/// machine.
struct CellRouteLimits {
  /// Largest number of expanded nodes (ranges of cell sides reached by a path), about 2 us each.
  std::size_t ways = 4'000'000;
  /// Returns true for a cell that a path may enter; empty: all cells. The search is faster without the cells
  /// from which the goal cannot be reached.
  std::function<bool(maps::Cell)> may_enter{};
};

/// Result of cellRoute().
struct CellRoute {
  Polyline points{};          ///< vertices of the route; empty if no route was found
  bool out_of_reach = false;  ///< true if it is proven that no route exists on any headings
  std::size_t cells = 0;      ///< if out_of_reach: number of cells reachable from the start
  maps::Point last{};         ///< if out_of_reach: centre of the reachable cell nearest to the goal
  std::size_t ways = 0;       ///< number of expanded nodes
  bool all_ways = false;      ///< false if a limit or a stop ended the search
};

/// Finds a route with arbitrary headings from `places.from` to `places.to`, or to within `tolerance_m` of it,
/// or proves that no route exists. It is used on maps on which the eight headings of the grid give no route,
/// and where Reach is undecided because Reach stores one range per cell side. Returns the straight line if it
/// is allowed. Otherwise the route leads from cell to cell. It crosses each side with a heading permitted in
/// both cells; inside a cell it alternates between the permitted headings on both sides of the required
/// direction. The route is not optimal and must be refined.
///
/// Method (ours). Dijkstra's algorithm over the sides of cells. A node is a range of a side that one path
/// reaches; parts that other paths reached before are removed, so that each part is expanded once.
/// laidChain() constructs the drive through the cells that lead to the goal. If the construction fails at a
/// cell, this cell is restricted to single arcs of headings; if the construction fails again, the cell is
/// excluded. If no path leads to the goal, the search is repeated with complete cones of directions and
/// closed sides, and with corners, which a drive may pass on a heading permitted in all cells at the corner.
/// If this search does not reach the goal either, no route exists. This search treats ranges below 1e-9 of a
/// side as rounding errors.
CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits = {}, const StopCheck& stop = {});

}  // namespace talus::planner
