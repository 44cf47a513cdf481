#include <cmath>

#include <talus/planner/simulation/drive/drive_log.hpp>

namespace talus::planner {
namespace drive_log_test {

DriveStep step(double expected_slip, double slip, double expected_J_per_m, double J_per_m) {
  DriveStep s;
  s.heading = {1.0, 0.0};
  s.length_m = 2.0;
  s.expected_slip = expected_slip;
  s.expected_energy_J_per_m = expected_J_per_m;
  s.truth.slip = slip;
  s.truth.energy_J_per_m = J_per_m;
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

}  // namespace drive_log_test
}  // namespace talus::planner
