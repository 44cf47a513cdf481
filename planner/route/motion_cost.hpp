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

/// The direction of a motion; east where it has no length.
costmap::Direction directionOf(const Segment& motion) noexcept;

/// Exact cost of straight motions: the integral of DriveCost along the segment, constant within each cell.
///
/// A motion is not allowed (infinite) where it leaves the map or enters a cell that the heading may not
/// enter. Cells are closed: a segment through a corner needs both cells beside it, a segment along an edge
/// needs both sides and costs the more expensive one; so nothing slips between two blocked cells that meet at
/// a corner. Cells crossed: Amanatides & Woo 1987 [amanatides_woo_1987]. Immutable, safe to share between
/// threads.
class MotionCost {
 public:
  explicit MotionCost(std::shared_ptr<const costmap::CostGrid> map);

  /// Cost of the motion in joules, >= 0; infinite when it is not allowed. Zero for a motion of no length on
  /// an allowed cell.
  double operator()(const Segment& motion) const noexcept;

  /// Cost of a polyline in joules, turns between its legs included; infinite when any part is not allowed. Zero for fewer than
  /// two points.
  double along(const std::vector<maps::Point>& points) const noexcept;

  /// Sum of the costs of a polyline's legs in joules, without its turns.
  double ofLegs(const std::vector<maps::Point>& points) const noexcept;

  /// Cost in joules of turning at a place from one heading to another the shorter way, DriveCost::turn() a radian; infinite where
  /// the rover tips in a heading between them. Free beside the map.
  double turn(maps::Point place, costmap::Direction from, costmap::Direction to) const noexcept;

  /// Whether a polyline may turn at an end of this motion as it begins or ends there: on an edge or a corner
  /// its heading must be allowed in every cell touched. The check of along() at each turn.
  bool turnAllowed(const Segment& motion, maps::Point end) const noexcept;

  /// Whether the heading, a unit vector, is allowed in every cell of the map that a place touches: two on an
  /// edge, four on a corner.
  bool headingAllowed(maps::Point place, costmap::Direction heading) const noexcept;

  /// Whether some heading may enter the cell of this point.
  bool allowed(maps::Point place) const noexcept;

  const costmap::CostGrid& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const costmap::CostGrid> map_;
};

}  // namespace talus::planner
