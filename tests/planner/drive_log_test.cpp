#include <cmath>
#include <sstream>

#include <planner/drive_log.hpp>

namespace talus::planner {
namespace {

DriveStep step(double expected_slip, double slip, double expected_J_per_m, double J_per_m) {
  DriveStep s;
  s.heading = {1.0, 0.0};
  s.length_m = 2.0;
  s.expected_slip = expected_slip;
  s.expected_energy_J_per_m = expected_J_per_m;
  s.truth.slip = slip;
  s.truth.energy_J_per_m = J_per_m;
  s.truth.wheels = {
      {.place = {1.0, 2.0}, .load_N = 50.0, .passes = 0, .forces = {.torque = 0.3, .sinkage = 0.1}},
      {.place = {0.0, 2.0}, .load_N = 40.0, .passes = 1, .forces = {.torque = 0.2, .sinkage = 0.05}}};
  return s;
}

TEST(DriveLog, ErrorsAreThoseOfTheSteps) {
  DriveLog log;
  log.record(step(0.1, 0.2, 100.0, 150.0));
  log.record(step(0.3, 0.3, 200.0, 250.0));
  const PredictionErrors e = log.errors();
  // Closed form: sqrt(0.01 / 2); 50 over a mean of 200; (600 - 800) / 800.
  EXPECT_EQ(e.steps, 2);
  EXPECT_NEAR(e.slip_rmse, std::sqrt(0.005), 1e-12);
  EXPECT_NEAR(e.energy_rmse, 0.25, 1e-12);
  EXPECT_NEAR(e.energy_error, -0.25, 1e-12);
  EXPECT_EQ(DriveLog{}.errors().steps, 0);
}

TEST(DriveLog, TelemetryHasARowAWheelNearTheTruthAndIsTheSameForASeed) {
  DriveLog log;
  for (int k = 0; k < 50; ++k) log.record(step(0.1, 0.4, 100.0, 150.0));
  terramech::Rover rover;
  rover.wheel = {.radius_m = 0.12, .width_m = 0.1};
  const std::string text = log.telemetry(rover, 7);
  EXPECT_EQ(text, log.telemetry(rover, 7));
  EXPECT_NE(text, log.telemetry(rover, 8));
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 11), "time_s,x_m,");
  int rows = 0;
  double torque = 0.0;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    for (int k = 0; k < 9 && std::getline(fields, field, ','); ++k) {
    }
    torque += std::stod(field);
    ++rows;
  }
  EXPECT_EQ(rows, 100);
  // Closed form: mean of 0.3 50 r and 0.2 40 r; 5 % over sqrt(100), three of them.
  EXPECT_NEAR(torque / rows, 0.5 * (15.0 + 8.0) * 0.12, 0.03 * 1.4);
}

}  // namespace
}  // namespace talus::planner
