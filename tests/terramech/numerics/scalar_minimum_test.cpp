#include <cmath>

#include <talus/terramech/numerics/scalar_minimum.hpp>

namespace talus::terramech {
namespace scalar_minimum_test {

TEST(ScalarMinimum, FindsTheGlobalMinimum) {
  // Closed form: with u = ln x the slope is 0 where 6 sin(6 u) = (u - 1)/5.
  const auto f = [](double x) {
    const double u = std::log(x);
    return std::cos(6.0 * u) + 0.1 * (u - 1.0) * (u - 1.0);
  };
  const Minimum least = globalMinimum(f, 0.01, 100.0);
  const double u = std::log(least.at);
  EXPECT_NEAR(6.0 * std::sin(6.0 * u), (u - 1.0) / 5.0, 1e-5);
  // Property: no value of a fine scan is lower by more than rounding.
  for (double v = -4.6; v < 4.6; v += 1e-3) EXPECT_GE(f(std::exp(v)), least.value - 1e-12);
}

TEST(ScalarMinimum, FindsAMinimumAtAnIntervalEnd) {
  const Minimum least = globalMinimum([](double x) { return x; }, 2.0, 8.0);
  EXPECT_EQ(least.at, 2.0);
}

}  // namespace scalar_minimum_test
}  // namespace talus::terramech
