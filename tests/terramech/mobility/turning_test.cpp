#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <talus/terramech/mobility/turning.hpp>

namespace talus::terramech {
namespace turning_test {

Rover fourWheels(Steering steering) {
  Rover rover{.name = "cart",
              .mass_kg = 100.0,
              .gravity_m_s2 = 2.0,
              .wheel_count = 4,
              .wheelbase_m = 1.2,
              .track_m = 0.9,
              .clearance_m = 0.2,
              .max_torque_Nm = 10.0,
              .max_speed_mps = 0.5,
              .steering = steering};
  rover.wheel.radius_m = 0.1;
  rover.wheel.width_m = 0.1;
  return rover;
}

TEST(Turning, SkidSteeringEnergyIsLateralFrictionWork) {
  const TurnEfforts efforts =
      turnEfforts(fourWheels(Steering::Skid), {.lateral_resistance = 0.5, .rolling_J_per_m = 40.0});
  // Closed form: 4 wheels of 50 N, each 0.6 m from the centre, at a lateral force over load of 0.5.
  EXPECT_DOUBLE_EQ(efforts.on_arc.energy_J, 0.5 * 4 * 50.0 * 0.6);
  // Closed form: in place, the rows at 0.45 m from the centre also roll in opposite directions.
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J, 60.0 + 40.0 * 0.45);
}

TEST(Turning, AllWheelSteeringRollsAboutTheCentre) {
  const TurnEfforts efforts = turnEfforts(fourWheels(Steering::AllWheel), {.rolling_J_per_m = 40.0});
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J,
                   30.0);  // Closed form: half the diagonal of 1.2 by 0.9 m is 0.75 m.
  EXPECT_DOUBLE_EQ(efforts.on_arc.energy_J, 0.0);
  // Closed form: the two middle wheels of six roll half the track.
  Rover six = fourWheels(Steering::AllWheel);
  six.wheel_count = 6;
  EXPECT_DOUBLE_EQ(turnEfforts(six, {.rolling_J_per_m = 40.0}).in_place.energy_J,
                   40.0 * (2.0 * 0.75 + 0.45) / 3.0);
}

TEST(Turning, TurnTimeIsLimitedByTheFastestWheel) {
  auto rover = fourWheels(Steering::AllWheel);
  rover.hotel_power_W = 10.0;
  const TurnEfforts efforts = turnEfforts(rover, {});
  // Closed form: on an arc the outer row rolls 0.45 m more per radian at 0.5 m/s; in place every wheel rolls
  // 0.75 m.
  EXPECT_DOUBLE_EQ(efforts.on_arc.time_s, 0.9);
  EXPECT_DOUBLE_EQ(efforts.in_place.time_s, 1.5);
  EXPECT_DOUBLE_EQ(efforts.in_place.energy_J, 15.0);
}

TEST(Turning, BulldozingForceMatchesPassiveEarthPressure) {
  const auto rover = fourWheels(Steering::Skid);
  Soil sand;
  sand.friction_angle_rad = std::numbers::pi / 6;  // K_p = tan^2(60 deg) = 3
  sand.density_kg_m3 = 1500.0;
  // Closed form: z = 2 cm of a wheel of 10 cm: chord 2 sqrt(0.004 - 0.0004) = 0.12 m.
  EXPECT_NEAR(bulldozing_N(sand, rover, 0.02), 0.5 * 1500.0 * 2.0 * 0.0004 * 3.0 * 0.12, 1e-12);
  sand.cohesion_Pa = 1000.0;
  EXPECT_NEAR(bulldozing_N(sand, rover, 0.02), 0.216 + 2.0 * 1000.0 * 0.02 * std::sqrt(3.0) * 0.12, 1e-9);
  EXPECT_DOUBLE_EQ(bulldozing_N(sand, rover, 0.0), 0.0);
  // Property: the energy of turning increases with the bulldozing force.
  EXPECT_GT(turnEfforts(rover, {.bulldozing_N = 5.0}).on_arc.energy_J,
            turnEfforts(rover, {}).on_arc.energy_J);
}

}  // namespace turning_test
}  // namespace talus::terramech
