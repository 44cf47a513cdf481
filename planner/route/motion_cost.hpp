#pragma once

#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// A straight motion in the map plane.
struct Segment {
  maps::Point from;
  maps::Point to;
};

/// Direction of a motion; east for zero length.
costmap::Direction directionOf(const Segment& motion) noexcept;

/// Exact cost of straight motions: integral of TravelCost along the segment, constant within each cell.
///
/// A motion that leaves the map, or enters a cell that does not permit the heading, is not allowed (infinite
/// cost). Cells are closed: a segment through a corner needs both adjacent cells, and a segment along an edge
/// needs both sides and has the cost of the more expensive side. A segment therefore cannot pass between two
/// blocked cells that meet at a corner. Traversal of cells: Amanatides & Woo 1987 [amanatides_woo_1987].
/// Immutable, safe to share between threads.
class MotionCost {
 public:
  explicit MotionCost(std::shared_ptr<const costmap::CostGrid> map);

  /// Returns the cost of the motion [J], >= 0; infinite if not allowed; zero for a motion of zero length on
  /// an allowed cell.
  double operator()(const Segment& motion) const noexcept;

  /// Returns the cost of a polyline [J], including turns between legs; infinite if any part is not allowed;
  /// zero for fewer than two points.
  double along(const std::vector<maps::Point>& points) const noexcept;

  /// Returns the sum of the costs of a polyline's legs [J], without turns.
  double ofLegs(const std::vector<maps::Point>& points) const noexcept;

  /// Returns the cost [J] of turning at a place from one heading to another by the smaller angle,
  /// TravelCost::turn() per radian; infinite if the rover tips in a heading in between. Free outside the map.
  double turn(maps::Point place, costmap::Direction from, costmap::Direction to) const noexcept;

  /// Returns true if a polyline may turn at an end of this motion: on an edge or a corner, every cell at the
  /// end must permit the heading. Used by along() at each turn.
  bool turnAllowed(const Segment& motion, maps::Point end) const noexcept;

  /// Returns true if every cell at a place permits the heading (unit vector): two cells on an edge, four on a
  /// corner.
  bool headingAllowed(maps::Point place, costmap::Direction heading) const noexcept;

  /// Returns true if the cell of this point permits any heading.
  bool allowed(maps::Point place) const noexcept;

  const costmap::CostGrid& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const costmap::CostGrid> map_;
};

}  // namespace talus::planner
