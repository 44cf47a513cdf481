#include <cmath>

#include <thesis_runs.hpp>

namespace talus::terramech {
namespace thesis_runs_test {

TEST(ThesisRuns, FollowTheThesisPattern) {
  // Printed in: thesis 2.3: slip 0.2 to 0.8 and back by 0.1, loads 60 to 100 N, Table 2.1.
  ThesisRuns runs(1);
  const ThesisRun run = runs.next({.noise = 0.0, .samples = 14});
  for (int k = 0; k < 14; ++k) {
    const auto& s = run.truth[static_cast<std::size_t>(k)];
    EXPECT_NEAR(s.slip, k <= 6 ? 0.2 + 0.1 * k : k <= 12 ? 1.4 - 0.1 * k : 0.3, 1e-12);
    EXPECT_GE(s.load_N, 60.0);
    EXPECT_LE(s.load_N, 100.0);
  }
  EXPECT_EQ(run.samples.front().torque_Nm, run.truth.front().torque_Nm);
}

TEST(ThesisRuns, NoiseHasTheStatedStd) {
  // Property: 2000 relative errors have the requested standard deviation, to 5 % (three of its standard
  // errors).
  ThesisRuns runs(2);
  double squares = 0.0;
  for (int k = 0; k < 50; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = 10});
    for (std::size_t i = 0; i < 10; ++i) {
      squares += std::pow(run.samples[i].load_N / run.truth[i].load_N - 1.0, 2);
      squares += std::pow(run.samples[i].torque_Nm / run.truth[i].torque_Nm - 1.0, 2);
      squares += std::pow(run.samples[i].sinkage_m / run.truth[i].sinkage_m - 1.0, 2);
      squares += std::pow(run.samples[i].slip / run.truth[i].slip - 1.0, 2);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / 2000.0), 0.05, 0.0025);
}

TEST(ThesisRuns, SameSeedReproducesTheRuns) {
  ThesisRuns one(3);
  ThesisRuns other(3);
  EXPECT_EQ(one.next().samples[7].torque_Nm, other.next().samples[7].torque_Nm);
}

}  // namespace thesis_runs_test
}  // namespace talus::terramech
