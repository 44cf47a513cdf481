#pragma once

#include <optional>
#include <vector>

#include <maps/grid.hpp>
#include <terramech/rover.hpp>

/// How a rover may move in the plane, and what turning takes.
namespace talus::planner {

/// Where the rover is and where it looks.
struct Pose {
  maps::Point place;
  double heading_rad = 0.0;  ///< counter-clockwise from x
};

/// What bends a route. The defaults are a rover that may do anything for free.
struct Kinematics {
  double turning_radius_m = 0.0;  ///< smallest radius of an arc, >= 0; 0: turns in place
  bool may_reverse = true;        ///< Reeds-Shepp when true, Dubins when false
  double turn_cost_J_per_rad =
      0.0;                   ///< added for each radian of heading, whether on an arc or in place, >= 0
  double cusp_cost_J = 0.0;  ///< added where the direction of travel reverses, >= 0
};

/// What turning takes beside the path's own length.
struct TurningGround {
  double lateral_resistance =
      0.6;  ///< lateral force over load of a wheel dragged sideways [-]; tan(phi) in soil
  double rolling_J_per_m = 0.0;  ///< of the whole rover on this ground, on the flat
};

/// Kinematics of a rover whose wheels are evenly spaced on two rows. A radian of heading takes, by Steering,
///   Skid:               mu sum_k (N_k |x_k|)     each axle dragged sideways through |x_k| (wong_2001, ch. 6,
///   for wheels) Ackermann/AllWheel: R_m rho                  each wheel rolls a circle about the centre, rho
///   half the diagonal
/// An Ackermann rover of no stated radius is refused: std::invalid_argument.
Kinematics kinematicsOf(const terramech::Rover& rover, const TurningGround& ground);

/// A stretch of constant curvature.
struct Arc {
  double length_m = 0.0;       ///< > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< left > 0 as the rover looks
};

/// The pose at the end of an arc that starts at a pose.
Pose after(const Pose& from, const Arc& arc) noexcept;

/// The shortest way between two poses for a turning radius > 0: Reeds-Shepp with reversing, else Dubins
/// (reeds_shepp_1990, dubins_1957; both by OMPL).
std::vector<Arc> shortestArcs(const Pose& from, const Pose& to, const Kinematics& kinematics);

}  // namespace talus::planner
