#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

/// What it takes a rover to change its heading.
namespace talus::terramech {

/// The ground that a rover turns on.
struct TurningGround {
  double lateral_resistance =
      0.6;                    ///< lateral force over load of a wheel dragged sideways [-]; tan(phi) in soil
  double bulldozing_N = 0.0;  ///< that the soil beside the sunk wheel adds for each wheel dragged, >= 0
  double rolling_J_per_m = 0.0;  ///< of the whole rover on this ground, on the flat
};

/// A radian of heading, beside the path's own length.
struct TurnEffort {
  double energy_J = 0.0;  ///< >= 0, the hotel's included
  double time_s = 0.0;    ///< >= 0
};

struct TurnEfforts {
  TurnEffort on_arc, in_place;
};

/// Soil pushed aside by the side of a wheel that is dragged sideways [N]: passive earth pressure on the sunk
/// part of its side, (rho g z^2 K_p / 2 + 2 c z sqrt(K_p)) l with K_p = tan^2(pi/4 + phi/2) after Rankine and
/// l = 2 sqrt(2 r z - z^2), the chord of the wheel in the surface. Ours; deeper than the mean depth of the
/// sunk side, so rather expensive.
double bulldozing_N(const Soil& soil, const Rover& rover, double sinkage_m) noexcept;

/// For a rover whose wheels are evenly spaced on two rows. By Steering:
///   Skid:                sum_k (mu N_k + B) |x_k|   each axle dragged sideways through |x_k| (wong_2001,
///                                                   ch. 6, for wheels), on an arc as in place; in place
///                                                   the rows also roll against each other, R_m b / 2
///   Ackermann, AllWheel: R_m mean rho_k in place    each wheel rolls a circle about the centre, rho_k its distance from
///                                                   that; nothing on an arc
/// Time: no wheel exceeds max_speed_mps, so that on an arc the outer row takes (b/2) / v longer a radian, and
/// in place max rho_k / v (Skid: (b/2) / v); the hotel's power is drawn meanwhile.
TurnEfforts turnEfforts(const Rover& rover, const TurningGround& ground) noexcept;

}  // namespace talus::terramech
