#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

/// Energy and time of a rover to change its heading.
namespace talus::terramech {

/// Ground properties for a turn.
struct TurningGround {
  double lateral_resistance =
      0.6;  ///< lateral force divided by load of a wheel dragged sideways [-]; tan(phi) in soil
  double bulldozing_N = 0.0;     ///< additional bulldozing force on each wheel dragged sideways, >= 0
  double rolling_J_per_m = 0.0;  ///< rolling energy of the whole rover on level ground
};

/// Additional energy and time per radian of heading, apart from the length of the path.
struct TurnEffort {
  double energy_J = 0.0;  ///< >= 0, includes hotel power
  double time_s = 0.0;    ///< >= 0
};

struct TurnEfforts {
  TurnEffort on_arc, in_place;
};

/// Returns the bulldozing force [N] on the side of a wheel dragged sideways, (rho g z^2 K_p / 2 + 2 c z
/// sqrt(K_p)) l, with Rankine's passive earth pressure K_p = tan^2(pi/4 + phi/2) and the chord l = 2 sqrt(2 r
/// z - z^2) of the wheel at the surface. Ours; the use of the full depth z instead of the mean depth is
/// conservative.
double bulldozing_N(const Soil& soil, const Rover& rover, double sinkage_m) noexcept;

/// Returns the efforts of a turn for a rover with evenly spaced wheels in two rows. Energy by Steering:
///   Skid:                sum_k (mu N_k + B) |x_k|   each axle is dragged sideways through |x_k| (wong_2001,
///                                                   ch. 6, for wheels), on an arc and in place; in place,
///                                                   rolling adds R_m b / 2
///   Ackermann, AllWheel: R_m mean rho_k in place    each wheel rolls on a circle of radius rho_k about the
///                                                   centre; 0 on an arc
/// Time per radian, with no wheel above v = max_speed_mps: (b/2) / v in addition on an arc, because of the
/// outer row; max rho_k / v in place (Skid: (b/2) / v). Hotel power is consumed during that time.
TurnEfforts turnEfforts(const Rover& rover, const TurningGround& ground) noexcept;

}  // namespace talus::terramech
