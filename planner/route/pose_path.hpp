#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route.hpp>

/// Routes in position and heading (poses joined by arcs), with their costs and sampled poses.
namespace talus::planner {

/// Drive: a sequence of arcs and turns in place that begins at the pose `start`.
struct PosePath {
  /// Leg of a drive: an arc, or a turn in place, which has an arc of zero length.
  struct Leg {
    Arc arc;
    double turn_rad = 0.0;  ///< angle of the turn in place, left > 0; requires arc.length_m = 0
  };
  Pose start;
  std::vector<Leg> legs;
};

/// Returns the pose after a leg that begins at the pose `from`.
Pose after(const Pose& from, const PosePath::Leg& leg) noexcept;

/// Cost of drives on one cost map for the kinematics of a rover. The cost is MotionCost along chords of at
/// most half a cell and 0.1 rad, plus the costs of turning and of cusps (changes between forward and
/// reverse). Driving in reverse costs as much as driving forward in the same direction, because the rover is
/// assumed to be symmetric. A turn in place is allowed only if the map permits every heading that the rover
/// passes. Immutable; safe to share between threads. `cost` must outlive the object.
class PoseCost {
 public:
  PoseCost(const MotionCost& cost, const Kinematics& kinematics);

  /// Returns the cost [J] of one leg from the pose `from`; infinite if a part of the leg is not allowed.
  double operator()(const Pose& from, const PosePath::Leg& leg) const noexcept;

  /// Returns the cost [J] of a drive, including cusps; infinite if a part of the drive is not allowed.
  double operator()(const PosePath& path) const noexcept;

  /// Returns the shortest path from `from` to `to` regardless of the ground. With a turning radius the path
  /// is that of ShortestCurves. Without a turning radius the rover turns in place, drives straight, and turns
  /// in place; it drives in reverse if reversing is permitted and reduces the turns. `forward` true: without
  /// reversing.
  std::vector<PosePath::Leg> direct(const Pose& from, const Pose& to, bool forward = false) const;

  /// Returns the kinematics of the rover.
  const Kinematics& kinematics() const noexcept { return kinematics_; }
  /// Returns the cost of straight motions.
  const MotionCost& motion() const noexcept { return cost_; }

 private:
  double arc(const Pose& from, const Arc& arc) const noexcept;
  double turnInPlace(const Pose& from, double turn_rad) const noexcept;
  const TurnCosts& turnsAt(maps::Point place) const noexcept;

  const MotionCost& cost_;
  Kinematics kinematics_;
  std::optional<ShortestCurves> curves_;  // empty: the rover turns in place
  double step_m_;
};

/// Returns the direction of motion of a leg: +1 forward, -1 in reverse, 0 for a turn in place.
int direction(const PosePath::Leg& leg) noexcept;

/// Returns poses along a drive, at most `step_m` apart, including the ends of its legs.
std::vector<Pose> sampled(const PosePath& path, double step_m);

/// Returns the poses that PoseCost connects by straight segments: the ends of straight legs, and the ends of
/// the chords of arcs.
std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map);

/// Returns the numbers of cusps and turns in place, and the largest curvature, of a drive.
RouteShape shape(const PosePath& path) noexcept;

/// Returns the length of a drive in the map plane [m].
double length_m(const PosePath& path) noexcept;

}  // namespace talus::planner
