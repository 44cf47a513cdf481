#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {
namespace simulated_sensors_test {

using costmap::testRover;

// A step of a four-wheeled rover at slip 0.3 with a sinkage of 0.2 of the wheel radius.
TrueWorld::Step step() {
  TrueWorld::Step made;
  made.slip = 0.3;
  for (int w = 0; w < 4; ++w)
    made.wheels.push_back({.place = {10.0 + w, 20.0}, .load_N = 50.0, .passes = w / 2, .forces = {}});
  for (auto& wheel : made.wheels) wheel.forces = {.pull = 0.1, .torque = 0.4, .sinkage = 0.2};
  return made;
}

WheelMeasurements lookOf(SimulatedSensors& sensors, double time_s = 5.0) {
  return sensors.look(step(), {.time_s = time_s, .heading = {0.0, 1.0}, .gradient = 0.1});
}

SensorOptions exact(SensorFault fault = SensorFault::None) {
  return {.noise = false, .pose_drift = 0.0, .fault = fault, .seed = 3};
}

TEST(SimulatedSensors, WithoutNoiseReadingsEqualTheTruth) {
  SimulatedSensors sensors(exact(), testRover());
  const WheelMeasurements look = lookOf(sensors);
  const double radius_m = testRover().wheel.radius_m;
  ASSERT_EQ(look.wheels.size(), 4U);
  for (std::size_t w = 0; w < 4; ++w) {
    // Closed form: without noise the readings equal the step.
    EXPECT_DOUBLE_EQ(look.wheels[w].slip, 0.3);
    EXPECT_DOUBLE_EQ(look.wheels[w].torque_Nm, 0.4 * 50.0 * radius_m);
    EXPECT_DOUBLE_EQ(look.wheels[w].sinkage_m, 0.2 * radius_m);
    EXPECT_DOUBLE_EQ(look.wheels[w].place.x_m, 10.0 + static_cast<double>(w));
    EXPECT_EQ(look.wheels[w].pass, static_cast<int>(w) / 2 + 1);
  }
}

TEST(SimulatedSensors, NoiseHasTheStatedStd) {
  SensorOptions options = exact();
  options.noise = true;
  SimulatedSensors sensors(options, testRover());
  double squares = 0.0;
  std::size_t missing = 0;
  constexpr int kLooks = 2000;
  for (int k = 0; k < kLooks; ++k) {
    const WheelMeasurements look = lookOf(sensors);
    squares += std::pow(look.wheels[0].slip - 0.3, 2);
    for (const auto& wheel : look.wheels) missing += std::isnan(wheel.torque_Nm) ? 1U : 0U;
  }
  // Property: standard deviations of 0.02 (rover) and 0.005 (wheel); tolerance four standard errors of 2000
  // draws.
  EXPECT_NEAR(std::sqrt(squares / kLooks), std::hypot(0.02, 0.005), 0.0014);
  EXPECT_NEAR(static_cast<double>(missing) / (4.0 * kLooks), 0.02, 0.0063);
}

TEST(SimulatedSensors, PoseErrorGrowsWithDistance) {
  SensorOptions options = exact();
  options.pose_drift = 0.02;
  SimulatedSensors sensors(options, testRover());
  for (int k = 0; k < 100; ++k) sensors.moved(0.5);
  const maps::Point there = sensors.estimatedPlace({7.0, 8.0});
  EXPECT_NEAR(std::hypot(there.x_m - 7.0, there.y_m - 8.0), 1.0, 1e-9);  // Closed form: 2 % of 50 m
}

// Effect of a fault on the faulty wheel and on the others.
TEST(SimulatedSensors, FaultAffectsOneSensorOnly) {
  const double radius_m = testRover().wheel.radius_m;
  for (const SensorFault fault : {SensorFault::SlipBiased, SensorFault::TorqueOffset,
                                  SensorFault::SinkageDatum, SensorFault::Silent, SensorFault::SlipStuck}) {
    SimulatedSensors sensors(exact(fault), testRover());
    const WheelMeasurements look = lookOf(sensors);
    for (std::size_t w = 0; w < 4; ++w) {
      const bool faulty = w == sensors.faultyWheel();
      const auto& read = look.wheels[w];
      EXPECT_EQ(std::isnan(read.slip), faulty && fault == SensorFault::Silent);
      if (faulty && fault == SensorFault::Silent) continue;
      EXPECT_NEAR(read.slip, faulty && fault == SensorFault::SlipBiased ? 0.1 : 0.3, 1e-12);
      EXPECT_NEAR(read.torque_Nm / (50.0 * radius_m),
                  faulty && fault == SensorFault::TorqueOffset ? 0.55 : 0.4, 1e-12);
      EXPECT_NEAR(read.sinkage_m / radius_m, faulty && fault == SensorFault::SinkageDatum ? 0.1 : 0.2, 1e-12);
    }
  }
}

TEST(SimulatedSensors, StuckSlipKeepsItsFirstValue) {
  SensorOptions options = exact(SensorFault::OdometryStuck);
  options.noise = true;
  SimulatedSensors sensors(options, testRover());
  const double first = lookOf(sensors).wheels[0].slip;
  for (int k = 0; k < 5; ++k)
    for (const auto& wheel : lookOf(sensors).wheels) EXPECT_EQ(wheel.slip, first);
}

TEST(TelemetryOf, TelemetryHasOneRowPerWheelWithSlip) {
  SimulatedSensors sensors(exact(SensorFault::Silent), testRover());
  const terramech::Telemetry rows = telemetryOf(lookOf(sensors, 7.5));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows.at("slip"), testing::Each(0.3));
  // Closed form: without noise the second slip 1 - speed_mps/rim_speed_mps is the true one.
  EXPECT_NEAR(1.0 - rows.at("speed_mps")[0] / rows.at("rim_speed_mps")[0], 0.3, 1e-12);
  SensorOptions once = exact(SensorFault::Silent);
  once.second_slip = false;
  SimulatedSensors without(once, testRover());
  EXPECT_TRUE(std::isnan(telemetryOf(lookOf(without, 7.5)).at("speed_mps")[0]));
  EXPECT_THAT(rows.at("time_s"), testing::Each(7.5));
  EXPECT_NEAR(rows.at("slope_rad")[0], std::atan(0.1), 1e-12);
  EXPECT_EQ(rows.findWords("wheel")->size(), 3U);
}

// With a drift of 1 the rover would never estimate itself at its goal, and the simulation would not end.
TEST(SimulatedSensors, PoseDriftOutOfRangeIsRejected) {
  for (const double drift : {-0.1, 0.6, 1.0, std::nan("")})
    EXPECT_REFUSED(SimulatedSensors({.pose_drift = drift}, testRover()), std::invalid_argument,
                   "pose_drift = " + std::to_string(drift) + ", must be 0 to 0.500000");
}

}  // namespace simulated_sensors_test
}  // namespace talus::planner
