#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <talus/maps/maps.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Sides of a cell. A position on a side is a number from 0 to 1, northwards or eastwards, and is therefore
/// the same number in both adjacent cells.
struct Side {
  enum : int { West, East, South, North };
};

/// Returns the same side as a side of the adjacent cell: west for east, south for north, and vice versa.
constexpr int otherSide(int side) noexcept {
  return side ^ 1;
}

/// Returns the cell adjacent to `cell` across a side.
constexpr maps::Cell beyond(maps::Cell cell, int side) noexcept {
  constexpr std::array<int, 4> kColumns{-1, 1, 0, 0}, kRows{0, 0, -1, 1};
  return {cell.column + kColumns[static_cast<std::size_t>(side)],
          cell.row + kRows[static_cast<std::size_t>(side)]};
}

/// Returns the heading of the outward normal of a side.
constexpr double outwards_rad(int side) noexcept {
  constexpr std::array<double, 4> kHeadings{std::numbers::pi, 0.0, 1.5 * std::numbers::pi,
                                            0.5 * std::numbers::pi};
  return kHeadings[static_cast<std::size_t>(side)];
}

/// Point in a cell, in units of the cell side length from the south-west corner of the cell.
struct InCell {
  double x = 0.0;
  double y = 0.0;
};

constexpr InCell operator+(InCell a, InCell b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
constexpr InCell operator-(InCell a, InCell b) noexcept {
  return {a.x - b.x, a.y - b.y};
}
constexpr InCell operator*(double s, InCell a) noexcept {
  return {s * a.x, s * a.y};
}

/// Converts a map position to a point in a cell.
inline InCell inCell(const maps::Grid& grid, maps::Cell cell, maps::Point p) noexcept {
  return {(p.x_m - grid.south_west.x_m) / grid.resolution_m - cell.column,
          (p.y_m - grid.south_west.y_m) / grid.resolution_m - cell.row};
}
/// Converts a point in a cell to map coordinates.
inline maps::Point onMap(const maps::Grid& grid, maps::Cell cell, InCell p) noexcept {
  return {grid.south_west.x_m + (cell.column + p.x) * grid.resolution_m,
          grid.south_west.y_m + (cell.row + p.y) * grid.resolution_m};
}

/// Returns the point at the position `at`, 0 to 1, on a side.
constexpr InCell onSide(int side, double at) noexcept {
  return side == Side::West    ? InCell{0.0, at}
         : side == Side::East  ? InCell{1.0, at}
         : side == Side::South ? InCell{at, 0.0}
                               : InCell{at, 1.0};
}

/// Closed range of positions on a side; empty if from > to.
struct SideRange {
  double from = 2.0;
  double to = -1.0;

  bool empty() const noexcept { return from > to; }
  /// Returns true if this range contains `other`.
  bool holds(const SideRange& other) const noexcept {
    return other.empty() || (from <= other.from && other.to <= to);
  }
  /// Returns the smallest range that contains both ranges.
  SideRange hull(const SideRange& other) const noexcept {
    return {std::min(from, other.from), std::max(to, other.to)};
  }
};

/// Returns true if a drive that alternates between headings of the set can move in every direction on uniform
/// ground. The set must not be empty.
inline bool leadsEverywhere(const HeadingSet& headings) noexcept {
  return headings.all() || 0.5 * HeadingSet::kTurn - headings.widestGap().width_rad > 0.0;
}

/// Directions in which a drive that alternates between headings of a set can move on uniform ground: all
/// directions, or a cone (sector) of at most pi. The set must not be empty.
class HeadingCone {
 public:
  /// `cut`, 0 to 0.5, is the share of the width of the cone that is removed at each end.
  explicit HeadingCone(const HeadingSet& headings, double cut = 0.0) noexcept {
    const auto [last, gap] = headings.widestGap();
    spare_rad_ = 0.5 * HeadingSet::kTurn - gap;
    everywhere_ = spare_rad_ > 0.0;
    const double in = cut * (HeadingSet::kTurn - gap), begin = last + gap + in, end = last - in;
    left_of_begin_ = {-std::sin(begin), std::cos(begin)};
    right_of_end_ = {std::sin(end), -std::cos(end)};
    ends_rad_ = {begin, end};
  }

  /// Returns the first and the last direction of the cone, counter-clockwise; meaningless if everywhere().
  const std::array<double, 2>& ends_rad() const noexcept { return ends_rad_; }

  /// Returns true if the cone contains all directions.
  bool everywhere() const noexcept { return everywhere_; }

  /// Returns pi minus the widest gap between headings [rad]. If the value is little above 0, a drive needs
  /// many turns to reach every point of the cell.
  double spare_rad() const noexcept { return spare_rad_; }

  /// Returns the range of a side that is reachable from the segment between the points a and b of the cell.
  /// `slack` [cell sides] widens the cone.
  SideRange reached(InCell a, InCell b, int side, double slack) const noexcept {
    return clipped(side, slack, {least(left_of_begin_, a, b), least(right_of_end_, a, b)}, 1.0);
  }

  /// Returns the range of a side from which the point `place` of the cell is reachable.
  SideRange reaching(InCell place, int side, double slack) const noexcept {
    return clipped(side, slack, {-dot(left_of_begin_, place), -dot(right_of_end_, place)}, -1.0);
  }

  /// Returns the polygon of the points of the cell that are reachable from the segment between a and b and at
  /// least `inside` [cell sides] away from the border. The result contains the corners in order; it is empty
  /// if there are no such points.
  std::vector<InCell> reachedPart(InCell a, InCell b, double slack, double inside) const {
    const double far = 1.0 - inside;
    std::vector<InCell> part{{inside, inside}, {far, inside}, {far, far}, {inside, far}};
    if (everywhere_) return part;
    for (const InCell normal : {left_of_begin_, right_of_end_}) {
      const double from = least(normal, a, b) - slack;
      std::vector<InCell> kept;
      for (std::size_t k = 0; k < part.size(); ++k) {
        const InCell here = part[k], next = part[(k + 1) % part.size()];
        const double in = dot(normal, here) - from, then = dot(normal, next) - from;
        if (in >= 0.0) kept.push_back(here);
        if ((in < 0.0) != (then < 0.0)) kept.push_back(here + (in / (in - then)) * (next - here));
      }
      part = std::move(kept);
    }
    return part;
  }

  /// Returns true if `to` is reachable from the segment between a and b.
  bool joins(InCell a, InCell b, InCell to, double slack) const noexcept {
    return everywhere_ || (dot(left_of_begin_, to) >= least(left_of_begin_, a, b) - slack &&
                           dot(right_of_end_, to) >= least(right_of_end_, a, b) - slack);
  }

 private:
  static double dot(InCell a, InCell b) noexcept { return a.x * b.x + a.y * b.y; }
  static double least(InCell normal, InCell a, InCell b) noexcept {
    return std::min(dot(normal, a), dot(normal, b));
  }

  // Returns the positions p on a side with sign * (normal . p) >= least - slack for both normals.
  SideRange clipped(int side, double slack, std::array<double, 2> least, double sign) const noexcept {
    SideRange range{0.0, 1.0};
    if (everywhere_) return range;
    const std::array normals{left_of_begin_, right_of_end_};
    for (std::size_t k = 0; k < 2; ++k) {
      const double at_0 = sign * dot(normals[k], onSide(side, 0.0)) - least[k] + slack;
      const double at_1 = sign * dot(normals[k], onSide(side, 1.0)) - least[k] + slack;
      if (at_0 < 0.0 && at_1 < 0.0) return {};
      const double crossing = at_0 / (at_0 - at_1);
      if (at_0 < 0.0) range.from = std::max(range.from, crossing);
      if (at_1 < 0.0) range.to = std::min(range.to, crossing);
    }
    return range.empty() ? SideRange{} : range;
  }

  bool everywhere_;
  double spare_rad_;
  std::array<double, 2> ends_rad_;
  InCell left_of_begin_, right_of_end_;
};

/// Gate of a cell: a point on its border where a drive enters or leaves the cell, with the heading of the
/// crossing; or the start or the end of a drive inside the cell, without a heading.
struct CellGate {
  InCell place{};
  /// Heading into the cell at the entry, out of the cell at the exit; empty inside the cell.
  std::optional<double> heading_rad{};
};

/// Constructs a drive through a cell with headings of the set `headings`, from gate `in` to gate `out`. Turns
/// are at least 3e-6 of the cell side length away from the border. The drive is straight if that is
/// permitted; otherwise it alternates between the two permitted headings on both sides of the required
/// direction. Both gates are crossed on straight legs, as long as possible. Returns the vertices from the
/// first vertex after the entry to the last vertex before the exit (including gates inside the cell). The
/// result is empty if more than kMostLegs legs were needed or no drive exists.
std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out);

/// Margins of a constructed drive, in units of the cell side length.
struct ChainMargins {
  double slack = -1e-6;  ///< margin by which cones of directions are widened; negative values narrow them
  double apart = 1e-5;   ///< smallest distance of crossings of cell sides from cell corners
};

/// Link of a chain of cells: a cell, the side through which the drive enters the cell (-1: the drive starts
/// in the cell), and the headings permitted in the cell.
struct ChainLink {
  maps::Cell cell;
  int side = -1;
  HeadingSet headings{};
  /// True if the drive can move in every direction by alternating between permitted headings.
  bool everywhere = false;
};

/// Result of laidChain(): a drive along a chain of cells.
struct LaidChain {
  Polyline points{};       ///< vertices of the drive; empty if no drive was found
  std::size_t failed = 0;  ///< if no drive was found: index of the first link that could not be crossed
};

/// Constructs a drive along a chain of cells, each of which shares a side with the next cell. The drive leads
/// from `places.from` in the first cell to `places.to` in the last cell, or to the nearest reachable point of
/// the last cell within `tolerance_m` of `places.to`. The drive is allowed by MotionCost.
///
/// Method (ours). A forward pass computes the range of each side that is reachable with directions inside the
/// cones of all cells (HeadingCone). Narrower cones leave more freedom to cross a side with a heading
/// permitted in both cells. A backward pass from the goal selects on each side a point from which the next
/// point is reachable, in the middle of the admissible range.
LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins = {});

/// Returns the point of `cell` nearest to `places.to` that is reachable, with directions in `cone`, from the
/// segment between the two points `from`. Returns nullopt if this point is farther than `tolerance_m` from
/// `places.to`; with tolerance 0, only `places.to` itself is accepted. `slack` [cell sides] widens the cone;
/// a negative value narrows the cone.
std::optional<InCell> nearestReached(const maps::Grid& grid, maps::Cell cell, const HeadingCone& cone,
                                     const std::pair<InCell, InCell>& from, const Segment& places,
                                     double tolerance_m, double slack);

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
