#pragma once

#include <array>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Energy and time that a rover needs to change its heading.

/// Ground properties that determine the energy of a turn.
struct TurningGround {
  /// Lateral force divided by load of a wheel that is dragged sideways [-]; tan(phi) in soil of friction
  /// angle phi.
  double lateral_resistance = 0.6;
  /// Bulldozing force B on each wheel that is dragged sideways, in addition, >= 0.
  double bulldozing_N = 0.0;
  double rolling_J_per_m = 0.0;  ///< rolling energy R_m of the whole rover per metre on level ground
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

/// Rover on an inclined plane: positions of the wheels, loads on the wheels, and angle to tip-over.

/// Vector in the plane of the ground, in the axes of the body.
struct Planar {
  double x = 0.0;  ///< forward component
  double y = 0.0;  ///< component to the left
};

/// Loads on the wheels of a rover on an inclined plane. The wheels are in left-right pairs on axles that are
/// evenly spaced over the wheelbase. Of all loads in equilibrium, those with the least sum of squares are
/// used, as a load-equalising suspension gives; for two axles this is the usual load transfer in pitch and
/// roll. Immutable; thread-safe.
class RoverStance {
 public:
  /// Largest number of wheels of a rover.
  static constexpr int kMostWheels = 12;
  /// Fraction of the normal force on each wheel; entries beyond wheels() are 0.
  using Loads = std::array<double, kMostWheels>;

  /// Throws std::invalid_argument if a field of the rover is outside its range, or if the number of wheels is
  /// odd or not in [4, 12].
  explicit RoverStance(const Rover& rover);

  int wheels() const { return wheels_; }

  /// Returns the position of a wheel from the mean position of all wheels [m]. Wheels are numbered from 0:
  /// front left, front right, left of the next axle, and so on.
  Planar position_m(int wheel) const { return position_m_[static_cast<std::size_t>(wheel)]; }

  /// Returns the projection of the centre of mass on the ground plane, from the mean position of all wheels
  /// [m].
  Planar centre_m() const { return centre_m_; }

  /// Returns the fraction of the normal force on each wheel; the fractions have sum 1. `demand` is the
  /// downhill component of the weight over its normal component, for each body axis: tan(slope), with x > 0
  /// if uphill is forward and y > 0 if uphill is to the left. The load moves downhill by the height of the
  /// centre of mass times `demand`. A wheel that would need a negative load has load 0.
  Loads shares(const Planar& demand) const;

  /// Returns the angle [rad] by which the plane may tilt further until the vertical through the centre of
  /// mass passes the nearest edge of the rectangle of the outermost wheels (static stability). A negative
  /// angle means that the rover tips over. Returns NaN if the height of the centre of mass is 0, i.e.
  /// unknown. `demand` has the meaning of the argument of shares().
  double stabilityMargin_rad(const Planar& demand) const;

 private:
  Loads lifted(const Planar& at, Loads shares) const;

  int wheels_ = 0;
  std::array<Planar, kMostWheels> position_m_{};
  double half_base_m_, half_track_m_, sum_xx_ = 0.0, sum_yy_ = 0.0;
  Planar centre_m_;
  double height_m_;
};

}  // namespace talus::terramech
