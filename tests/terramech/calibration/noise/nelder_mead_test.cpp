#include <cmath>

#include <talus/terramech/calibration/noise/nelder_mead.hpp>

namespace talus::terramech {
namespace nelder_mead_test {

TEST(NelderMead, MinimisesAQuadratic) {
  // Closed form: (x - 1)^2 + 3 (y + 2)^2 + (x - 1)(y + 2) is least at (1, -2).
  const auto bowl = [](const std::vector<double>& p) {
    const double x = p[0] - 1.0, y = p[1] + 2.0;
    return x * x + 3.0 * y * y + x * y;
  };
  const auto found = nelderMead(bowl, {5.0, 5.0}, {.tolerance = 1e-12});
  EXPECT_NEAR(found[0], 1.0, 1e-5);
  EXPECT_NEAR(found[1], -2.0, 1e-5);
}

TEST(NelderMead, MinimisesRosenbrock) {
  // Closed form: the least value is 0 at (1, 1). The start is that of nelder_mead_1965.
  const auto valley = [](const std::vector<double>& p) {
    return 100.0 * std::pow(p[1] - p[0] * p[0], 2) + std::pow(1.0 - p[0], 2);
  };
  const auto found = nelderMead(valley, {-1.2, 1.0}, {.tolerance = 1e-14});
  EXPECT_NEAR(found[0], 1.0, 1e-4);
  EXPECT_NEAR(found[1], 1.0, 1e-4);
}

TEST(NelderMead, LimitsEvaluationsAndNeverIncreasesTheCost) {
  for (const int most : {4, 7, 20, 50}) {
    int calls = 0;
    const auto cost = [&](const std::vector<double>& p) {
      ++calls;
      return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
    };
    const auto found = nelderMead(cost, {3.0, -4.0, 5.0}, {.evaluations = most});
    EXPECT_LE(calls, most + 4) << most;  // the current step is completed: at most two trials and a shrink
    EXPECT_LE(cost(found), 12.0);
  }
}

TEST(NelderMead, StopsAtOnceOnAConstantFunction) {
  int calls = 0;
  nelderMead([&](const std::vector<double>&) { return ++calls, 7.0; }, {0.0, 0.0}, {});
  EXPECT_EQ(calls, 3);  // evaluations at the corners of the first simplex
}

}  // namespace nelder_mead_test
}  // namespace talus::terramech
