#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/planner/route/arc.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {
class GroundModel;
}

/// Motion constraints of a rover in the plane, and costs of turning.
namespace talus::planner {

using costmap::TurnCost;
using costmap::TurnCosts;

/// Constraints on the curvature of a route. By default all motions are permitted and turning is free.
struct Kinematics {
  double turning_radius_m = 0.0;            ///< smallest radius of an arc, 0.001 to 1000; 0: turns in place
  bool may_reverse = true;                  ///< Reeds-Shepp when true, Dubins when false
  TurnCosts turns{};                        ///< per radian, on ground not in `turns_by_curve`
  std::vector<TurnCosts> turns_by_curve{};  ///< by the number of the drive curve
  TurnCost cusp{};                          ///< change between forward and reverse
  TurnCost stop{};                          ///< per turn in place: stop, steer the wheels, restart

  /// Returns the costs of one radian of turning on ground with a curve index.
  const TurnCosts& turnsOn(std::uint8_t curve) const noexcept {
    return curve < turns_by_curve.size() ? turns_by_curve[curve] : turns;
  }
};

/// Kinematics of the map's rover, with turning costs from the curves of a cost function. A change between
/// forward and reverse takes the time to drive one wheel radius, a stop for a turn in place 20 s (ours),
/// which prevents drives with a turn at every cell. Throws std::invalid_argument for an Ackermann rover
/// without a turning radius.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::TravelCost& cost);

/// Shortest paths between poses for a turning radius > 0: Reeds-Shepp with reversing (reeds_shepp_1990,
/// OMPL's implementation), otherwise Dubins (dubins.hpp). Immutable, safe to share between threads.
class ShortestCurves {
 public:
  /// Throws std::invalid_argument for a radius outside 0.001 to 1000 m.
  explicit ShortestCurves(const Kinematics& kinematics);
  ~ShortestCurves();
  ShortestCurves(ShortestCurves&&) noexcept;

  /// The shortest path between two poses; without reversing unless `may_reverse`.
  std::vector<Arc> operator()(const Pose& from, const Pose& to) const;

  /// The shortest path without reversing.
  std::vector<Arc> forward(const Pose& from, const Pose& to) const;

 private:
  struct Spaces;
  std::unique_ptr<const Spaces> spaces_;
  double radius_m_;
  bool may_reverse_;
};

/// ShortestCurves for a single pair of poses.
std::vector<Arc> shortestArcs(const Pose& from, const Pose& to, const Kinematics& kinematics);

}  // namespace talus::planner
