#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {
class GroundModel;
}

/// Constraints on the motion of a rover in the map plane, and costs of turning.

namespace talus::planner {

/// Position and heading of the rover.
struct Pose {
  maps::Point place;         ///< map coordinates [m]
  double heading_rad = 0.0;  ///< heading, counter-clockwise from x (east)
};

/// Path section of constant curvature: a circular arc or a straight line.
struct Arc {
  double length_m = 0.0;       ///< signed length, > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< curvature [1/m], > 0 for an arc to the left of the heading
};

/// Returns the pose at the end of an arc that starts at `from`.
Pose after(const Pose& from, const Arc& arc) noexcept;

/// Returns the shortest path without reversing from `from` to `to`, with arcs of the turning radius
/// `radius_m` > 0 (dubins_1957), in the closed forms of shkel_lumelsky_2001. The implementation of OMPL 1.5.2
/// is not used: it compares the length with a bound, which long paths miss by rounding, and then aborts the
/// process.
std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m);

using costmap::TurnCost;
using costmap::TurnCosts;

/// Constraints on the curvature of a route, and costs of turning. The default values permit all motions and
/// free turns.
struct Kinematics {
  double turning_radius_m = 0.0;  ///< smallest radius of an arc, 0.001 to 1000; 0: the rover turns in place
  bool may_reverse = true;  ///< true: paths of Reeds and Shepp; false: paths of Dubins, without reversing
  TurnCosts turns{};        ///< costs of one radian on ground without an entry in `turns_by_curve`
  /// Costs of one radian by kind of ground, indexed by CellCode::curve().
  std::vector<TurnCosts> turns_by_curve{};
  TurnCost cusp{};  ///< cost of a change between forward and reverse
  TurnCost stop{};  ///< cost of one turn in place beside its angle: stop, steer the wheels, restart

  /// Returns the costs of one radian of turning on a cell with CellCode::curve() = `curve`, the index of the
  /// cost curve of its ground.
  const TurnCosts& turnsOn(costmap::CellCode::Curve curve) const noexcept {
    return curve < turns_by_curve.size() ? turns_by_curve[curve] : turns;
  }
};

/// Returns the kinematics of the rover of `model`, with the turning costs of `cost`. A change between forward
/// and reverse takes the time in which the rover drives one wheel radius. A stop for a turn in place takes 20
/// s (ours), so that planned routes do not turn at every cell. Throws std::invalid_argument for an Ackermann
/// rover without a turning radius.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::TravelCost& cost);

/// Shortest paths between two poses for a turning radius > 0: paths of Reeds and Shepp if the rover may
/// reverse (reeds_shepp_1990, implementation of OMPL), otherwise paths of Dubins. Immutable,
/// safe to share between threads.
class ShortestCurves {
 public:
  /// Throws std::invalid_argument for a radius outside 0.001 to 1000 m.
  explicit ShortestCurves(const Kinematics& kinematics);
  ~ShortestCurves();
  ShortestCurves(ShortestCurves&&) noexcept;

  /// Returns the shortest path from pose `from` to pose `to`, with reversing only if Kinematics::may_reverse
  /// is true.
  std::vector<Arc> operator()(const Pose& from, const Pose& to) const;

  /// Returns the shortest path from `from` to `to` without reversing.
  std::vector<Arc> forward(const Pose& from, const Pose& to) const;

 private:
  struct Spaces;
  std::unique_ptr<const Spaces> spaces_;
  double radius_m_;
  bool may_reverse_;
};

}  // namespace talus::planner
