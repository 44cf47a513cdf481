#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/kinematics.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/route.hpp>

/// Routes in position and heading: poses joined by arcs; their costs and samples.
namespace talus::planner {

/// A drive: arcs in sequence from the first pose. A turn in place is an arc of zero length with `turn_rad`.
struct PosePath {
  /// An arc or a turn in place.
  struct Leg {
    Arc arc;
    double turn_rad = 0.0;  ///< in place, left > 0; requires arc.length_m = 0
  };
  Pose start;
  std::vector<Leg> legs;
};

/// The pose after a leg.
Pose after(const Pose& from, const PosePath::Leg& leg) noexcept;

/// Cost of drives on one map for the kinematics of a rover: MotionCost along chords of at most half a cell
/// and 0.1 rad, plus costs of turning and cusps. Reversing costs as much as driving forward in that
/// direction, because the rover is assumed symmetric. A turn in place requires every heading passed to be
/// permitted. Immutable; safe to share between threads.
class PoseCost {
 public:
  PoseCost(const MotionCost& cost, const Kinematics& kinematics);

  /// Returns the cost of one leg from a pose [J]; infinite if any part is not allowed.
  double operator()(const Pose& from, const PosePath::Leg& leg) const noexcept;

  /// Returns the cost of a drive including cusps [J]; infinite if any part is not allowed.
  double operator()(const PosePath& path) const noexcept;

  /// Shortest path between two poses: ShortestCurves, or for a rover that turns in place: turn, drive
  /// straight (in reverse if that requires less turning and is permitted), turn. `forward`: without
  /// reversing.
  std::vector<PosePath::Leg> direct(const Pose& from, const Pose& to, bool forward = false) const;

  const Kinematics& kinematics() const noexcept { return kinematics_; }
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

/// +1 forward, -1 in reverse, 0 turning in place.
int direction(const PosePath::Leg& leg) noexcept;

/// Poses along a drive, at most `step_m` apart, including the ends of legs.
std::vector<Pose> sampled(const PosePath& path, double step_m);

/// Poses between which PoseCost uses straight segments: ends of straight legs, chords of arcs.
std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map);

/// Returns the number of cusps and turns, and curvature, of a drive.
RouteShape shape(const PosePath& path) noexcept;

/// Returns the length in the map plane [m].
double length_m(const PosePath& path) noexcept;

}  // namespace talus::planner
