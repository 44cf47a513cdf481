#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/terramech/effects/refined_model.hpp>
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

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 500.0,
          .friction_angle_rad = 0.56,
          .sinkage_exponent = 0.9,
          .frictional_modulus = 1.7e6,
          .shear_modulus_m = 0.02};
}

TEST(SteeringLimit, SideForceEqualsTheDemandAtTheLimit) {
  const SteeringDemand demand{.load_N = 80.0};
  const double limit = steeringSlipLimit(sand(), Wheel{}, demand);
  ASSERT_GT(limit, 0.0);
  ASSERT_LT(limit, 1.0);
  WheelContact contact = contactOf(sand(), Wheel{});
  contact.load_N = 80.0;
  contact.slip = limit;
  contact.slip_angle_rad = demand.slip_angle_rad;
  EXPECT_NEAR(std::abs(solveContact(contact).side_force_N) / 80.0, 0.1, 1e-6);  // Closed form: the root.
}

TEST(SteeringLimit, DecreasesWithDemandAndIncreasesWithSlipAngle) {
  const auto limit = [](double demand, double angle) {
    return steeringSlipLimit(sand(), Wheel{},
                             {.load_N = 80.0, .slip_angle_rad = angle, .side_force_over_load = demand});
  };
  EXPECT_GT(limit(0.05, 0.26), limit(0.1, 0.26));  // Property: monotone in the side force.
  EXPECT_GT(limit(0.1, 0.4), limit(0.1, 0.26));
  EXPECT_EQ(limit(5.0, 0.26), 0.0);
}

TEST(SteeringLimit, InvalidDemandIsRejected) {
  EXPECT_REFUSED(steeringSlipLimit(sand(), Wheel{}, {.load_N = -1.0}), std::invalid_argument,
                 "load_N = -1, must be > 0");
}

Rover rover(int wheels = 4) {
  return {.name = "box",
          .mass_kg = 40.0,
          .wheel_count = wheels,
          .wheel = {},
          .wheelbase_m = 0.8,
          .track_m = 0.6,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 20.0};
}

TEST(RoverStance, PitchAndRollTransferLoad) {
  const RoverStance stance{rover()};
  const auto n = stance.shares({0.2, 0.1});
  // Closed form: load transfer h/L tan(pitch) and h/T tan(roll), half at each wheel.
  const double back = 0.3 / 0.8 * 0.2 / 2.0, right = 0.3 / 0.6 * 0.1 / 2.0;
  EXPECT_NEAR(n[0], 0.25 - back - right, 1e-12);  // front left, uphill in both directions
  EXPECT_NEAR(n[1], 0.25 - back + right, 1e-12);
  EXPECT_NEAR(n[2], 0.25 + back - right, 1e-12);
  EXPECT_NEAR(n[3], 0.25 + back + right, 1e-12);
}

TEST(RoverStance, ForcesAndMomentsBalance) {
  for (const int wheels : {4, 6, 8}) {
    Rover r = rover(wheels);
    r.centre_of_mass_ahead_m = 0.1;
    r.centre_of_mass_left_m = -0.05;
    const RoverStance stance{r};
    for (const Planar demand : {Planar{0.0, 0.0}, Planar{0.3, -0.2}, Planar{-0.5, 0.4}, Planar{0.7, 0.5}}) {
      const auto n = stance.shares(demand);
      double sum = 0.0, x = 0.0, y = 0.0;
      for (int k = 0; k < wheels; ++k) {
        const double share = n[static_cast<std::size_t>(k)];
        EXPECT_GE(share, 0.0);
        sum += share;
        x += share * stance.position_m(k).x;
        y += share * stance.position_m(k).y;
      }
      // Closed form: the resultant of the normal forces meets the line of the weight in the plane, with or
      // without lifted wheels.
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(x, 0.1 - 0.3 * demand.x, 1e-9) << wheels << ' ' << demand.x;
      EXPECT_NEAR(y, -0.05 - 0.3 * demand.y, 1e-9) << wheels << ' ' << demand.y;
    }
  }
}

TEST(RoverStance, StabilityMarginIsZeroAtTheTippingSlope) {
  const RoverStance stance{rover()};
  // Closed form: half the base over the height, half the track over the height.
  EXPECT_NEAR(stance.stabilityMargin_rad({0.4 / 0.3, 0.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, 1.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, -0.5}), std::atan(1.0) - std::atan(0.5), 1e-12);
  EXPECT_LT(stance.stabilityMargin_rad({0.0, 1.1}), 0.0);
}

TEST(RoverStance, WithoutCentreOfMassHeightLoadsAreEqualAndMarginIsNan) {
  Rover r = rover();
  r.centre_of_mass_height_m = 0.0;
  const RoverStance stance{r};
  EXPECT_EQ(stance.shares({0.4, 0.3})[0], 0.25);  // Closed form
  EXPECT_TRUE(std::isnan(stance.stabilityMargin_rad({0.1, 0.0})));
}

std::string refusal(const Rover& r) {
  try {
    const RoverStance stance{r};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(RoverStance, InvalidGeometryIsRejected) {
  Rover r = rover();
  r.centre_of_mass_ahead_m = 0.5;
  EXPECT_NE(refusal(r).find("rover 'box': centre_of_mass_ahead_m = 0.5"), std::string::npos) << refusal(r);
  r = rover();
  r.track_m = 0.0;
  EXPECT_NE(refusal(r).find("track_m = 0, must be > 0"), std::string::npos) << refusal(r);
  EXPECT_NE(refusal(rover(1)).find("wheels.count = 1"), std::string::npos);
  EXPECT_NE(refusal(rover(3)).find("must be even, 4 to 12"), std::string::npos) << refusal(rover(3));
}

}  // namespace turning_test

}  // namespace talus::terramech
