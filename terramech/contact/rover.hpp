#pragma once

#include <string>

#include <talus/terramech/contact/wheel.hpp>

namespace talus::terramech {

/// Steering system of a rover: skid steering, steered front wheels (Ackermann) or all wheels steered.
enum class Steering { Skid, Ackermann, AllWheel };

/// Rover parameters for route planning. All wheels are equal. Plain data in SI units.
struct Rover {
  std::string name;               ///< name of the rover in reports and errors
  double mass_kg = 0.0;           ///< total mass m, in [0.1, 1e6]
  double gravity_m_s2 = 9.80665;  ///< gravity g at the driving site, in [1e-4, 1e3]
  int wheel_count = 4;            ///< number of wheels, in [2, 100]
  Wheel wheel;                    ///< each wheel; radius and width in [1e-3, 10] m, grouser height <= radius
  double wheelbase_m = 0.0;       ///< distance from first to last axle, in [1e-3, 100]
  double track_m = 0.0;           ///< distance between left and right wheel centres, in [1e-3, 100]
  double clearance_m = 0.0;       ///< height of the belly above ground, in [1e-3, max(wheelbase, track)]
  /// Height above ground, >= 0; 0: unknown, without load transfer and tip-over.
  double centre_of_mass_height_m = 0.0;
  /// Forward offset of the centre of mass from mid wheelbase, +-0.499 wheelbase.
  double centre_of_mass_ahead_m = 0.0;
  double centre_of_mass_left_m = 0.0;  ///< offset to the left from the middle of the track, +-0.499 track
  double max_pitch_rad = 0.35;         ///< limit of the rover's tilt along the heading, (0, pi/2)
  double max_roll_rad = 0.35;          ///< limit of the rover's tilt across the heading, (0, pi/2)
  double max_torque_Nm = 0.0;          ///< largest torque of one wheel, in (0, 1e6]
  double max_speed_mps = 0.05;         ///< largest rim speed of the wheels, in [1e-4, 100]
  double turning_radius_m = 0.0;       ///< smallest turning radius: 0 (turn in place) or in [0.001, 1000]
  double hotel_power_W = 0.0;          ///< electrical power that is independent of driving, in [0, 1e6]
  Steering steering = Steering::Skid;

  bool operator==(const Rover&) const = default;
};

/// Returns the load m g / wheel_count [N] on one wheel on level ground.
double wheelLoad_N(const Rover& rover);

/// Throws std::invalid_argument that names rover, field, value and bound if a field is outside its range.
void validate(const Rover& rover);

}  // namespace talus::terramech
