#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

double shearGain(const Wheel& wheel) noexcept {
  const double h = wheel.grouser_height_m, b = wheel.width_m;
  return h > 0.0 && wheel.lug_thrust > 0.0 ? 1.0 + wheel.lug_thrust * 0.64 * h / b * std::atan(b / h) : 1.0;
}

void validate(const Wheel& wheel) {
  const RangeCheck check{"wheel"};
  check.above("radius_m", wheel.radius_m, 0.0);
  check.above("width_m", wheel.width_m, 0.0);
  check.within("radius_m", wheel.radius_m, {1e-4, 10.0});
  check.within("width_m", wheel.width_m, {1e-4, 10.0});
  check.within("grouser_height_m", wheel.grouser_height_m, {0.0, 1.0});
  check.within("grouser_count", wheel.grouser_count, {0.0, 1000.0});
  check.within("lug_thrust", wheel.lug_thrust, {0.0, 5.0});
}

double sinkageModulus(const Soil& soil, double width_m) {
  return soil.cohesive_modulus / width_m + soil.frictional_modulus;
}

Soil underGravity(Soil soil, double gravity_m_s2, double exponent) {
  if (soil.test_gravity_m_s2 <= gravity_m_s2) return soil;
  const double factor = std::pow(gravity_m_s2 / soil.test_gravity_m_s2, exponent);
  soil.cohesion_Pa *= factor;
  soil.cohesive_modulus *= factor;
  soil.frictional_modulus *= factor;
  soil.test_gravity_m_s2 = 0.0;
  return soil;
}

void validate(const Soil& soil) {
  const RangeCheck check{"soil '" + soil.name + "'"};
  check.atLeast("cohesion_Pa", soil.cohesion_Pa, 0.0);
  check.within("friction_angle_rad", soil.friction_angle_rad, {0.0, 1.5707963});
  check.above("sinkage_exponent", soil.sinkage_exponent, 0.0);
  check.finite("cohesive_modulus", soil.cohesive_modulus);
  check.finite("frictional_modulus", soil.frictional_modulus);
  check.above("shear_modulus_m", soil.shear_modulus_m, 0.0);
  check.finite("c1", soil.c1);
  check.finite("c2", soil.c2);
  check.above("density_kg_m3", soil.density_kg_m3, 0.0);
  check.within("slip_sinkage_exponent", soil.slip_sinkage_exponent, {0.0, 2.0});
  check.within("digging_exponent", soil.digging_exponent, {0.0, 2.0});
  check.atLeast("side_bulldozing", soil.side_bulldozing, 0.0);
  check.within("rut_stiffness", soil.rut_stiffness, {1.0, 1e3});
  check.within("test_gravity_m_s2", soil.test_gravity_m_s2, {0.0, 1e3});
  check.within("correlation_time_s", soil.correlation_time_s, {0.0, 1e12});
  // Upper bounds are at least a hundred times the values of any known soil.
  check.within("cohesion_Pa", soil.cohesion_Pa, {0.0, 1e9});
  check.within("sinkage_exponent", soil.sinkage_exponent, {1e-3, 100.0});
  check.within("shear_modulus_m", soil.shear_modulus_m, {1e-9, 1e3});
  check.within("density_kg_m3", soil.density_kg_m3, {0.1, 1e6});
}

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
