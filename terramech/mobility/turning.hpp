#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

/// Energy and time that a rover needs to change its heading.
namespace talus::terramech {

/// Ground properties that determine the energy of a turn.
struct TurningGround {
  /// Lateral force divided by load of a wheel that is dragged sideways [-]; tan(phi) in soil of friction
  /// angle phi.
  double lateral_resistance = 0.6;
  /// Bulldozing force B on each wheel that is dragged sideways, in addition, >= 0.
  double bulldozing_N = 0.0;
  double rolling_J_per_m = 0.0;  ///< rolling energy R_m of the whole rover per metre on level ground
};

/// Energy and time of a turn per radian of heading change, in addition to those of the path length.
struct TurnEffort {
  double energy_J = 0.0;  ///< energy [J/rad], >= 0, includes hotel power (power independent of driving)
  double time_s = 0.0;    ///< time [s/rad], >= 0
};

/// Efforts of a turn while driving on an arc, and of a turn in place.
struct TurnEfforts {
  TurnEffort on_arc, in_place;
};

/// Returns the bulldozing force [N] on the side face of a wheel that is dragged sideways at the sinkage z =
/// sinkage_m: (rho g z^2 K_p / 2 + 2 c z sqrt(K_p)) l. K_p = tan^2(pi/4 + phi/2) is Rankine's coefficient of
/// passive earth pressure, and l = 2 sqrt(2 r z - z^2) is the chord of the wheel at the surface. The formula
/// is ours; the use of the full depth z in place of the mean depth is conservative.
double bulldozing_N(const Soil& soil, const Rover& rover, double sinkage_m) noexcept;

/// Returns the efforts of a turn for a rover with evenly spaced wheels in a left and a right row, a track b
/// apart. mu is lateral_resistance, N_k the load of wheel k, and x_k its forward position from the middle of
/// the rover. Energy per radian by kind of steering:
///   Skid:                sum_k (mu N_k + B) |x_k|   each axle is dragged sideways through |x_k| (wong_2001,
///                                                   ch. 6, for wheels), on an arc and in place; in place,
///                                                   rolling adds R_m b / 2
///   Ackermann, AllWheel: R_m mean rho_k in place    each wheel rolls on a circle of radius rho_k about the
///                                                   centre; 0 on an arc
/// Time per radian, with no rim faster than v = max_speed_mps: on an arc the outer row of wheels adds (b/2) /
/// v; in place the time is max rho_k / v, and (b/2) / v for skid steering. Hotel power is consumed during
/// this time.
TurnEfforts turnEfforts(const Rover& rover, const TurningGround& ground) noexcept;

}  // namespace talus::terramech
