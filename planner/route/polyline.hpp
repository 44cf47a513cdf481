#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::planner {

/// Polyline: points in map coordinates [m], connected by straight legs.
using Polyline = std::vector<maps::Point>;

/// Returns the polyline with each leg divided into equal parts of at most `longest_m` > 0.
Polyline subdivided(const Polyline& points, double longest_m);

/// Returns the length of the polyline [m].
double length_m(const Polyline& points) noexcept;

/// Cuts the polyline where its remaining length to the end is offset_m, offset_m + piece_m, offset_m + 2
/// piece_m, ... Because lengths are measured from the end, changes near the start do not move later cuts. The
/// pieces are in order from start to end; each piece begins at the end of the previous piece. A first piece
/// shorter than piece_m / 2 is joined to the second piece. Returns at least one piece. piece_m > 0; 0 <
/// offset_m <= piece_m.
std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m);

/// Cuts the polyline at marks. A mark is a point of the polyline with the smallest hash value of all its
/// points within the distance apart_m along the path. Marks depend on the nearby points only; therefore
/// changes elsewhere on the polyline move no cut. Cuts are more than apart_m apart; for dense points the mean
/// distance is twice as long.
std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m);

/// Splits the polyline at the point from which the length to the end is left_m, 0 < left_m < length.
std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m);

/// Returns the polyline up to the first point within the distance `tolerance_m` >= 0 of the goal, or the
/// complete polyline if there is no such point.
Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m);

/// Appends `piece`, which must begin at the end of `points`.
void append(Polyline& points, const Polyline& piece);

/// Straight motion in the map plane.
struct Segment {
  maps::Point from;
  maps::Point to;
};

/// Returns the direction of the motion as a unit vector; east for a motion of zero length.
costmap::Direction directionOf(const Segment& motion) noexcept;

/// Exact cost of straight motions: the integral of TravelCost along the segment. The cost per metre is
/// constant within each cell.
///
/// A motion is not allowed (its cost is infinite) if it leaves the map or passes a cell on a heading that the
/// cost map does not permit there. Cells are closed sets: a segment through a corner passes all four adjacent
/// cells, and a segment along an edge passes the cells on both sides and has the cost of the more expensive
/// side. Therefore no segment passes between two blocked cells that meet at a corner. Cells are traversed
/// after Amanatides & Woo 1987 [amanatides_woo_1987]. Immutable, safe to share between threads.
class MotionCost {
 public:
  /// The map must not be null.
  explicit MotionCost(std::shared_ptr<const costmap::CostGrid> map);

  /// Returns the cost of the motion [J], >= 0; infinite if the motion is not allowed; 0 for a motion of zero
  /// length in a cell that permits any heading.
  double operator()(const Segment& motion) const noexcept;

  /// Returns the cost of a polyline [J], including the turns between its legs; infinite if a leg or a turn is
  /// not allowed; 0 for fewer than two points.
  double along(const std::vector<maps::Point>& points) const noexcept;

  /// Returns the sum of the costs of the legs of a polyline [J], without the costs of turns.
  double ofLegs(const std::vector<maps::Point>& points) const noexcept;

  /// Returns the cost [J] of the turn at `place` from heading `from` to heading `to` through the smaller
  /// angle: TravelCost::turn() times the angle [rad]. Returns infinity if the rover tips at a heading between
  /// both, and 0 outside the map.
  double turn(maps::Point place, costmap::Direction from, costmap::Direction to) const noexcept;

  /// Returns true if a polyline may turn at `end`, one of the two ends of `motion`: every cell that contains
  /// `end` (two cells on an edge, four at a corner) permits the heading of the motion. along() checks this at
  /// each turn.
  bool turnAllowed(const Segment& motion, maps::Point end) const noexcept;

  /// Returns true if every cell that contains `place` permits `heading` (unit vector). A point on an edge
  /// belongs to two cells, a point at a corner to four.
  bool headingAllowed(maps::Point place, costmap::Direction heading) const noexcept;

  /// Returns true if the cell that contains `place` permits at least one heading.
  bool allowed(maps::Point place) const noexcept;

  /// Returns the cost map.
  const costmap::CostGrid& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const costmap::CostGrid> map_;
};

/// Returns the cells of `grid` that intersect the closed disc with the centre `place` and the radius
/// `radius_m`. Cells are closed sets: for radius 0, a place on a cell side has two cells, a place at a corner
/// four.
std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m);

}  // namespace talus::planner
