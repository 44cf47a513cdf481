#pragma once

#include <memory>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// A four-wheeled rover of 60 kg on Mars, for tests.
inline terramech::Rover testRover() {
  return {.name = "test rover",
          .mass_kg = 60.0,
          .gravity_m_s2 = 3.72,
          .wheel_count = 4,
          .wheel = {.radius_m = 0.12, .width_m = 0.12},
          .wheelbase_m = 0.8,
          .track_m = 0.6,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 15.0,
          .max_speed_mps = 0.1,
          .hotel_power_W = 15.0};
}

/// A sand that carries the test rover well.
inline terramech::Soil testSand() {
  return {.name = "test sand",
          .cohesion_Pa = 800.0,
          .friction_angle_rad = 0.63,
          .sinkage_exponent = 1.0,
          .cohesive_modulus = 1400.0,
          .frictional_modulus = 820000.0,
          .shear_modulus_m = 0.015};
}

/// A weaker and softer sand.
inline terramech::Soil testDust() {
  terramech::Soil soil = testSand();
  soil.name = "test dust";
  soil.cohesion_Pa = 100.0;
  soil.friction_angle_rad = 0.45;
  soil.frictional_modulus = 150000.0;
  return soil;
}

/// Sand as class 1 (the default), dust as class 2.
inline std::shared_ptr<const GroundModel> testGround(const TravelPolicy& policy = {}) {
  return std::make_shared<GroundModel>(GroundModel::Parts{
      .rover = testRover(),
      .classes = {GroundClass{.number = 1, .soil = testSand()}, GroundClass{.number = 2, .soil = testDust()}},
      .policy = policy});
}

}  // namespace talus::costmap
