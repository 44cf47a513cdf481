#pragma once

#include <string>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Steering system of a rover.
enum class Steering { Skid, Ackermann, AllWheel };

/// Rover parameters for route planning; all wheels are equal. Plain data, SI.
struct Rover {
  std::string name;               ///< name in reports and errors
  double mass_kg = 0.0;           ///< in [0.1, 1e6]
  double gravity_m_s2 = 9.80665;  ///< gravity where the rover drives, in [1e-4, 1e3]
  int wheel_count = 4;            ///< in [2, 100]
  Wheel wheel;               ///< each wheel; radius and width in [1e-3, 10], grousers not above the radius
  double wheelbase_m = 0.0;  ///< first to last axle, in [1e-3, 100]
  double track_m = 0.0;      ///< left to right wheel centres, in [1e-3, 100]
  double clearance_m = 0.0;  ///< ground to belly, in [1e-3, max(wheelbase, track)]
  double centre_of_mass_height_m = 0.0;  ///< above ground, >= 0; 0: unknown, no load transfer or tip-over
  double centre_of_mass_ahead_m = 0.0;   ///< from the middle of the wheelbase, +-0.499 wheelbase
  double centre_of_mass_left_m = 0.0;    ///< from the middle of the track, +-0.499 track
  double max_pitch_rad = 0.35;           ///< limit of the tilt along the heading, (0, pi/2)
  double max_roll_rad = 0.35;            ///< limit of the tilt across the heading, (0, pi/2)
  double max_torque_Nm = 0.0;            ///< per wheel, in (0, 1e6]
  double max_speed_mps = 0.05;           ///< rim speed on level ground, in [1e-4, 100]
  double turning_radius_m = 0.0;         ///< 0: turns in place; otherwise in [0.001, 1000]
  double hotel_power_W = 0.0;            ///< power independent of driving, in [0, 1e6]
  Steering steering = Steering::Skid;
};

/// Returns the load on one wheel on level ground, m g / count [N].
double wheelLoad_N(const Rover& rover);

/// Throws std::invalid_argument with rover, field, value and bound if a field is outside its range.
void validate(const Rover& rover);

}  // namespace talus::terramech
