#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/kinematics.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

/// Routes in position and heading: poses joined by arcs, priced and sampled.
namespace talus::planner {

/// A drive: from the first pose along the arcs, one after another. A turn in place is an arc of no length
/// with `turn_rad`.
struct PosePath {
  /// An arc or a turn in place.
  struct Leg {
    Arc arc;
    double turn_rad = 0.0;  ///< in place, left > 0; only where arc.length_m is 0
  };
  Pose start;
  std::vector<Leg> legs;
};

/// The pose after a leg.
Pose after(const Pose& from, const PosePath::Leg& leg) noexcept;

/// The price of drives on one map for one rover's kinematics: MotionCost along chords no longer than half a
/// cell and bending no more than 0.1 rad, plus turning and cusps. Driving in reverse costs what driving that
/// way costs: the rover is taken as symmetric. Turning in place needs every heading on the way to be allowed.
/// Immutable; safe to share between threads.
class PoseCost {
 public:
  PoseCost(const MotionCost& cost, const Kinematics& kinematics);

  /// Joules of one leg from a pose; infinite when any part is not allowed.
  double operator()(const Pose& from, const PosePath::Leg& leg) const noexcept;

  /// Joules of a drive, cusps counted; infinite when any part is not allowed.
  double operator()(const PosePath& path) const noexcept;

  /// The shortest way between two poses: ShortestCurves, or turn, drive straight, turn for a rover that turns
  /// in place (in reverse when that turns less and is allowed). `forward`: without reversing.
  std::vector<PosePath::Leg> direct(const Pose& from, const Pose& to, bool forward = false) const;

  const Kinematics& kinematics() const noexcept { return kinematics_; }
  const MotionCost& motion() const noexcept { return cost_; }

 private:
  double arc(const Pose& from, const Arc& arc) const noexcept;
  double turnInPlace(const Pose& from, double turn_rad) const noexcept;
  const TurnPrices& turnsAt(maps::Point place) const noexcept;

  const MotionCost& cost_;
  Kinematics kinematics_;
  std::optional<ShortestCurves> curves_;  // none: turns in place
  double step_m_;
};

/// +1 forward, -1 in reverse, 0 turning in place.
int direction(const PosePath::Leg& leg) noexcept;

/// Poses along a drive at most `step_m` apart, ends of legs included.
std::vector<Pose> sampled(const PosePath& path, double step_m);

/// The poses between which PoseCost drives straight: ends of straight legs, chords of arcs.
std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map);

/// What a controller would notice.
DriveShape shape(const PosePath& path) noexcept;

/// Length along the map plane.
double length_m(const PosePath& path) noexcept;

}  // namespace talus::planner
