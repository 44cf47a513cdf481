#include <cmath>
#include <stdexcept>

#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace normal_distribution_test {

TEST(NormalDistribution, QuantileInvertsTheDistribution) {
  // Property: quantile and probability are inverse to each other, from the far tail to the upper range.
  for (const double x : {-30.0, -8.0, -2.0, -0.3, 0.0, 0.7, 3.0, 6.0}) {
    const double p = normalProbability(x);
    // Above the median p is rounded to 1e-16.
    const double tolerance = 1e-10 + (x > 0.0 ? 1e-16 / normalDensity(x) : 0.0);
    EXPECT_NEAR(normalQuantile(p), x, tolerance);
  }
}

TEST(NormalDistribution, QuantileAt975PerMilleMatchesReferenceAndZeroIsRejected) {
  // Closed form: 1.959963984540054.
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_THROW((void)normalQuantile(0.0), std::invalid_argument);
}

TEST(EvenPoints, FillTheUnitCubeUniformly) {
  // Property: the mean of each coordinate of a Halton sequence is 1/2 to about log(n)/n.
  const auto points = evenPoints(5, 1024);
  for (int row = 0; row < 5; ++row) EXPECT_NEAR(points.row(row).mean(), 0.5, 0.01);
  EXPECT_GT(points.minCoeff(), 0.0);
  EXPECT_LT(points.maxCoeff(), 1.0);
}

}  // namespace normal_distribution_test
}  // namespace talus::terramech
