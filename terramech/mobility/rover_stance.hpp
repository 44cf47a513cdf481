#pragma once

#include <array>

#include <talus/terramech/contact/rover.hpp>

/// How a rover stands on an inclined plane: where its wheels are, what each carries, how far it is from
/// tipping.
namespace talus::terramech {

/// Components along two axes of a rover: x ahead, y to the left.
struct Planar {
  double x = 0.0;
  double y = 0.0;
};

/// Loads of a rover's wheels on a plane. Wheels stand in pairs, axles evenly from the front to the back of
/// the wheelbase, and share the load so that the sum of squares is least, as a suspension that evens loads
/// does: with two axles that is N = m g cos(alpha) (1/4 +- ...), the textbook's transfer in pitch and in
/// roll. Immutable; thread-safe.
class RoverStance {
 public:
  static constexpr int kMostWheels = 12;
  using Loads = std::array<double, kMostWheels>;

  /// Throws std::invalid_argument when a field leaves its range, or wheels.count is not even, 4 to 12.
  explicit RoverStance(const Rover& rover);

  int wheels() const { return wheels_; }

  /// Where wheel k stands from the middle of the wheels [m]; front left, front right, then the next axle.
  Planar position_m(int wheel) const { return position_m_[static_cast<std::size_t>(wheel)]; }

  /// Where the centre of mass stands above the ground's plane [m].
  Planar centre_m() const { return centre_m_; }

  /// Share of the force normal to the plane that each wheel carries; they add up to 1. `demand` is the weight
  /// along the plane over the weight normal to it that the ground must hold, per axis: tan(slope), uphill
  /// positive. Weight moves by height times demand downhill. A wheel that would be pulled down carries
  /// nothing, the others all.
  Loads shares(const Planar& demand) const;

  /// The angle [rad] by which the plane may still tilt, to the edge that is nearest, before the centre of
  /// mass passes over it; < 0: the rover has tipped (static stability). NaN where the height is 0, which
  /// counts as unknown.
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
