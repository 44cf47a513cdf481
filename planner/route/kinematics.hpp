#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/planner/route/arc.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {
class GroundModel;
}

/// How a rover may move in the plane, and what turning takes.
namespace talus::planner {

using costmap::TurnPrice;
using costmap::TurnPrices;

/// What bends a route. The defaults are a rover that may do anything for free.
struct Kinematics {
  double turning_radius_m = 0.0;             ///< smallest radius of an arc, 0.001 to 1000; 0: turns in place
  bool may_reverse = true;                   ///< Reeds-Shepp when true, Dubins when false
  TurnPrices turns{};                        ///< a radian, on ground that `turns_by_curve` leaves out
  std::vector<TurnPrices> turns_by_curve{};  ///< by the number of the drive curve
  TurnPrice cusp{};                          ///< a change between forward and reverse
  TurnPrice stop{};  ///< for each turn in place: to stop, to set the wheels, to start again

  /// What turning takes on ground of a curve.
  const TurnPrices& turnsOn(std::uint8_t curve) const noexcept {
    return curve < turns_by_curve.size() ? turns_by_curve[curve] : turns;
  }
};

/// Kinematics of a rover, turning priced by the curves of a cost function. A change of direction takes the time to drive a
/// wheel radius, a stop to turn in place twenty seconds (ours): that is what keeps a drive from turning at every cell. An
/// Ackermann rover of no stated radius is refused: std::invalid_argument.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::DriveCost& cost);

/// The shortest ways between poses for a turning radius > 0: Reeds-Shepp with reversing, else Dubins
/// (reeds_shepp_1990, by OMPL; dubins.hpp). Immutable, safe to share between threads.
class ShortestCurves {
 public:
  /// Throws std::invalid_argument for a radius outside of 0.001 to 1000 m.
  explicit ShortestCurves(const Kinematics& kinematics);
  ~ShortestCurves();
  ShortestCurves(ShortestCurves&&) noexcept;

  std::vector<Arc> operator()(const Pose& from, const Pose& to) const;

  /// The same without reversing.
  std::vector<Arc> forward(const Pose& from, const Pose& to) const;

 private:
  struct Spaces;
  std::unique_ptr<const Spaces> spaces_;
  double radius_m_;
  bool may_reverse_;
};

/// ShortestCurves for one pair.
std::vector<Arc> shortestArcs(const Pose& from, const Pose& to, const Kinematics& kinematics);

}  // namespace talus::planner
