#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <talus/maps/grid/grid.hpp>
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

}  // namespace talus::planner
