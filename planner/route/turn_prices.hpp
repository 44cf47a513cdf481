#pragma once

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/soil.hpp>

namespace talus::planner {

/// What turning takes beside the path's own length.
struct TurningGround {
  double lateral_resistance =
      0.6;                    ///< lateral force over load of a wheel dragged sideways [-]; tan(phi) in soil
  double bulldozing_N = 0.0;  ///< that the soil beside the sunk wheel adds for each wheel dragged, >= 0
  double rolling_J_per_m = 0.0;  ///< of the whole rover on this ground, on the flat
  double time_weight_W = 0.0;    ///< joules that one second is worth
};

/// Soil pushed aside by the side of a wheel that is dragged sideways [N]: passive earth pressure on the sunk
/// part of its side, (rho g z^2 K_p / 2 + 2 c z sqrt(K_p)) l with K_p = tan^2(pi/4 + phi/2) after Rankine and
/// l = 2 sqrt(2 r z - z^2), the chord of the wheel in the surface. Ours; deeper than the mean depth of the
/// sunk side, so rather expensive.
double bulldozing_N(const terramech::Soil& soil, const terramech::Rover& rover, double sinkage_m) noexcept;

/// A radian of heading for a rover whose wheels are evenly spaced on two rows. By Steering:
///   Skid:                sum_k (mu N_k + B) |x_k|   each axle dragged sideways through |x_k| (wong_2001,
///                                                   ch. 6, for wheels), on an arc as in place; in place
///                                                   the rows also roll against each other, R_m b / 2
///   Ackermann, AllWheel: R_m rho in place           each wheel rolls a circle about the centre, rho half
///                                                   the diagonal; nothing on an arc
/// Time: no wheel exceeds max_speed_mps, so that on an arc the outer row takes (b/2) / v longer a radian, and
/// in place rho / v (Skid: (b/2) / v); the hotel's power is drawn meanwhile.
TurnPrices turnPrices(const terramech::Rover& rover, const TurningGround& ground) noexcept;

/// Kinematics of a rover on ground of one kind. A change of direction takes the time to drive a wheel radius,
/// a stop to turn in place twenty seconds (ours): that is what keeps a drive from turning at every cell. An
/// Ackermann rover of no stated radius is refused: std::invalid_argument.
Kinematics kinematicsOf(const terramech::Rover& rover, const TurningGround& ground);

/// Kinematics on a map: turning priced by the ground of each drive curve, with the sinkage that its table
/// states on the flat. Curves beyond the model's classes (learned ground) take the softest soil's friction.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::DriveCost& cost);

}  // namespace talus::planner
