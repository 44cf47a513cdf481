#include <algorithm>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/turning_radius.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

double wheelLoad_N(const Rover& rover) {
  return rover.mass_kg * rover.gravity_m_s2 / rover.wheel_count;
}

void validate(const Rover& rover) {
  const RangeCheck check{"rover '" + rover.name + "'"};
  check.above("mass_kg", rover.mass_kg, 0.0);
  check.above("gravity_m_s2", rover.gravity_m_s2, 0.0);
  check.atLeast("wheels.count", rover.wheel_count, 2.0);
  check.above("wheels.radius_m", rover.wheel.radius_m, 0.0);
  check.above("wheels.width_m", rover.wheel.width_m, 0.0);
  check.atLeast("wheels.grouser_height_m", rover.wheel.grouser_height_m, 0.0);
  check.atLeast("wheels.grouser_count", rover.wheel.grouser_count, 0.0);
  check.within("wheels.grouser_height_m", rover.wheel.grouser_height_m, {0.0, rover.wheel.radius_m});
  check.within("wheels.grouser_count", rover.wheel.grouser_count, {0.0, 1000.0});
  check.within("wheels.lug_thrust", rover.wheel.lug_thrust, {0.0, 5.0});
  check.above("wheelbase_m", rover.wheelbase_m, 0.0);
  check.above("track_m", rover.track_m, 0.0);
  check.above("clearance_m", rover.clearance_m, 0.0);
  check.atLeast("centre_of_mass_height_m", rover.centre_of_mass_height_m, 0.0);
  // A rover with the centre of mass outside the wheels would tip.
  const double most_ahead = 0.499 * rover.wheelbase_m, most_left = 0.499 * rover.track_m;
  check.within("centre_of_mass_ahead_m", rover.centre_of_mass_ahead_m, {-most_ahead, most_ahead});
  check.within("centre_of_mass_left_m", rover.centre_of_mass_left_m, {-most_left, most_left});
  check.above("max_pitch_rad", rover.max_pitch_rad, 0.0);
  check.above("max_roll_rad", rover.max_roll_rad, 0.0);
  check.within("max_pitch_rad", rover.max_pitch_rad, {0.0, 1.5707963});
  check.within("max_roll_rad", rover.max_roll_rad, {0.0, 1.5707963});
  check.above("max_torque_Nm", rover.max_torque_Nm, 0.0);
  check.above("max_speed_mps", rover.max_speed_mps, 0.0);
  check.atLeast("hotel_power_W", rover.hotel_power_W, 0.0);
  // A value outside these limits is assumed to have a wrong unit; a footprint of that size is not usable on a
  // grid.
  check.within("mass_kg", rover.mass_kg, {0.1, 1e6});
  check.within("gravity_m_s2", rover.gravity_m_s2, {1e-4, 1e3});
  check.within("wheels.count", rover.wheel_count, {2.0, 100.0});
  check.within("wheels.radius_m", rover.wheel.radius_m, {1e-3, 10.0});
  check.within("wheels.width_m", rover.wheel.width_m, {1e-3, 10.0});
  check.within("wheelbase_m", rover.wheelbase_m, {1e-3, 100.0});
  check.within("track_m", rover.track_m, {1e-3, 100.0});
  check.zeroOrWithin("turning_radius_m", rover.turning_radius_m, {kSmallestTurn_m, kLargestTurn_m});
  check.within("max_torque_Nm", rover.max_torque_Nm, {0.0, 1e6});
  check.within("max_speed_mps", rover.max_speed_mps, {1e-4, 100.0});
  check.within("hotel_power_W", rover.hotel_power_W, {0.0, 1e6});
  // A clearance above the larger of length and width is assumed to have a wrong unit; steps and rocks would
  // not be detected as hazards.
  check.within("clearance_m", rover.clearance_m, {1e-3, std::max(rover.wheelbase_m, rover.track_m)});
}

}  // namespace talus::terramech
