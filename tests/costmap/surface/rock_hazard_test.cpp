#include <cmath>
#include <limits>
#include <numbers>

#include <talus/costmap/surface/rock_hazard.hpp>

namespace talus::costmap {
namespace rock_hazard_test {

// Number of rocks per square metre with a diameter above d, by quadrature of the definition.
double rocksByQuadrature(double k, double d) {
  const double q = 1.79 + 0.152 / k;
  const double step = 1e-4;
  double sum = 0.0;
  for (double x = d + 0.5 * step; x < 20.0; x += step)
    sum += k * q * std::exp(-q * x) * 4.0 / (std::numbers::pi * x * x) * step;
  return sum;
}

TEST(RockHazard, MatchesItsDefinition) {
  for (const double k : {0.01, 0.05, 0.2, 0.4})
    for (const double d : {0.1, 0.4, 1.0}) {
      // Closed form: midpoint rule over the same density, good to 1e-5 at this step.
      const double expected = 1.0 - std::exp(-rocksByQuadrature(k, d) * 2.5);
      EXPECT_NEAR(rockHazard(k, {.diameter_m = d, .area_m2 = 2.5}), expected, 1e-5 * expected + 1e-12);
    }
}

TEST(RockHazard, WithoutRocksTheHazardIsZero) {
  EXPECT_EQ(rockHazard(0.0, {.diameter_m = 0.1, .area_m2 = 1.0}), 0.0);
  EXPECT_EQ(rockHazard(std::numeric_limits<double>::quiet_NaN(), {.diameter_m = 0.1, .area_m2 = 1.0}), 0.0);
}

// Property: the hazard never decreases with rock abundance. (The fitted distribution alone would leave 0.55
// of such places free at an abundance of 0.9.)
TEST(RockHazard, HazardIsMonotoneInRockAbundance) {
  const RockCrossing fido{.diameter_m = 0.46, .area_m2 = 0.7};
  double last = 0.0;
  for (int percent = 1; percent <= 100; ++percent) {
    const double now = rockHazard(0.01 * percent, fido);
    EXPECT_GE(now, last) << percent;
    last = now;
  }
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(rockHazard(0.51, fido), 1.0);
}

}  // namespace rock_hazard_test
}  // namespace talus::costmap
