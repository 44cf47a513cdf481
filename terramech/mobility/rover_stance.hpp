#pragma once

#include <array>

#include <talus/terramech/contact/rover.hpp>

/// Rover on an inclined plane: wheel positions, wheel loads and distance from tip-over.
namespace talus::terramech {

/// Components in two directions: x forward, y to the left.
struct Planar {
  double x = 0.0;
  double y = 0.0;
};

/// Loads of the wheels of a rover on a plane. Wheels are in pairs on axles evenly spaced over the wheelbase.
/// The loads have the least sum of squares, as with a load-equalising suspension; for two axles this is the
/// usual load transfer in pitch and roll. Immutable; thread-safe.
class RoverStance {
 public:
  static constexpr int kMostWheels = 12;
  using Loads = std::array<double, kMostWheels>;

  /// Throws std::invalid_argument if a field is outside its range, or wheels.count is not even or not in [4,
  /// 12].
  explicit RoverStance(const Rover& rover);

  int wheels() const { return wheels_; }

  /// Returns the position of wheel k from the middle of the wheels [m]; order: front left, front right, next
  /// axle.
  Planar position_m(int wheel) const { return position_m_[static_cast<std::size_t>(wheel)]; }

  /// Returns the position of the centre of mass, projected on the ground plane [m].
  Planar centre_m() const { return centre_m_; }

  /// Returns the fraction of the normal force on each wheel, with sum 1. `demand` is the tangential over the
  /// normal component of the weight per direction: tan(slope), uphill positive. Load shifts downhill by
  /// height times demand. A wheel that would need a negative load has load 0.
  Loads shares(const Planar& demand) const;

  /// Returns the angle [rad] by which the plane may tilt further before the centre of mass passes the nearest
  /// edge (static stability); negative: tipped over. NaN if the height is 0, which means unknown.
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
