#include <cmath>

#include <talus/planner/simulation/drive/traverse_log.hpp>

namespace talus::planner {
namespace traverse_log_test {

TraverseStep step(double expected_slip, double slip, double expected_J_per_m, double J_per_m) {
  TraverseStep s;
  s.heading = {1.0, 0.0};
  s.length_m = 2.0;
  s.expected_slip = expected_slip;
  s.expected_energy_J_per_m = expected_J_per_m;
  s.truth.slip = slip;
  s.truth.energy_J_per_m = J_per_m;
  return s;
}

TEST(TraverseLog, ErrorsAreThoseOfTheRecordedSteps) {
  TraverseLog log;
  log.record(step(0.1, 0.2, 100.0, 150.0));
  log.record(step(0.3, 0.3, 200.0, 250.0));
  const PredictionErrors e = log.errors();
  // Closed form: sqrt(0.01 / 2); 50 over a mean of 200; (600 - 800) / 800.
  EXPECT_EQ(e.steps, 2);
  EXPECT_NEAR(e.slip_rmse, std::sqrt(0.005), 1e-12);
  EXPECT_NEAR(e.energy_rmse, 0.25, 1e-12);
  EXPECT_NEAR(e.energy_error, -0.25, 1e-12);
  EXPECT_EQ(TraverseLog{}.errors().steps, 0);
}

}  // namespace traverse_log_test
}  // namespace talus::planner
