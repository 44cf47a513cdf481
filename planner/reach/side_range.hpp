#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <talus/maps/maps.hpp>
#include <talus/planner/route/heading_set.hpp>

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

/// Converts a map position to a point in a cell.
inline InCell inCell(const maps::Grid& grid, maps::Cell cell, maps::Point p) noexcept {
  return {(p.x_m - grid.south_west.x_m) / grid.resolution_m - cell.column,
          (p.y_m - grid.south_west.y_m) / grid.resolution_m - cell.row};
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
  explicit HeadingCone(const HeadingSet& headings) noexcept : everywhere_(leadsEverywhere(headings)) {
    const auto [last, gap] = headings.widestGap();
    left_of_begin_ = {-std::sin(last + gap), std::cos(last + gap)};
    right_of_end_ = {std::sin(last), -std::cos(last)};
  }

  /// Returns the range of a side that is reachable from the segment between the points a and b of the cell.
  /// `slack` [cell sides] widens the cone.
  SideRange reached(InCell a, InCell b, int side, double slack) const noexcept {
    SideRange range{0.0, 1.0};
    if (everywhere_) return range;
    for (const InCell normal : {left_of_begin_, right_of_end_}) {
      const double from = least(normal, a, b) - slack;
      const double at_0 = dot(normal, onSide(side, 0.0)) - from, at_1 = dot(normal, onSide(side, 1.0)) - from;
      if (at_0 < 0.0 && at_1 < 0.0) return {};
      const double crossing = at_0 / (at_0 - at_1);
      if (at_0 < 0.0) range.from = std::max(range.from, crossing);
      if (at_1 < 0.0) range.to = std::min(range.to, crossing);
    }
    return range.empty() ? SideRange{} : range;
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

  bool everywhere_;
  InCell left_of_begin_, right_of_end_;
};

}  // namespace talus::planner
