#pragma once

#include <string>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// How a rover turns.
enum class Steering { Skid, Ackermann, AllWheel };

/// A rover as route planning models it, with equal wheels. Plain data, SI.
struct Rover {
  std::string name;               ///< for reports
  double mass_kg = 0.0;           ///< in [0.1, 1e6]
  double gravity_m_s2 = 9.80665;  ///< > 0, of the body it drives on
  int wheel_count = 4;            ///< >= 2
  Wheel wheel;                    ///< one of its wheels
  double wheelbase_m = 0.0;       ///< first to last axle, > 0
  double track_m = 0.0;           ///< left to right wheel centres, > 0
  double clearance_m = 0.0;       ///< ground to belly, > 0, at most the larger of wheelbase and track
  double centre_of_mass_height_m =
      0.0;  ///< above ground, >= 0; 0: unknown, no load moves on a slope, none tips
  double centre_of_mass_ahead_m = 0.0;  ///< of the middle of the wheelbase, within it
  double centre_of_mass_left_m = 0.0;   ///< of the middle of the track, within it
  double max_pitch_rad = 0.35;          ///< tilt along the heading, (0, pi/2)
  double max_roll_rad = 0.35;           ///< tilt across the heading, (0, pi/2)
  double max_torque_Nm = 0.0;           ///< per wheel, > 0
  double max_speed_mps = 0.05;          ///< rim speed on the flat, in [1e-4, 100]
  double turning_radius_m = 0.0;        ///< 0: turns in place; else 0.001 to 1000
  double hotel_power_W = 0.0;           ///< drawn whether it drives or not, >= 0
  Steering steering = Steering::Skid;
};

/// Load on one wheel on the flat, m g / count [N].
double wheelLoad_N(const Rover& rover);

/// Throws std::invalid_argument naming rover, field, value and bound when a field leaves its range.
void validate(const Rover& rover);

}  // namespace talus::terramech
