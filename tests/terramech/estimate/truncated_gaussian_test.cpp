#include <cmath>
#include <limits>
#include <numbers>

#include <talus/terramech/estimate/truncated_gaussian.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace truncated_gaussian_test {

const SoilBox kUnit{SoilVector::Zero(), SoilVector::Ones()};

SoilMatrix correlated() {
  SoilMatrix a;
  a << 2, .5, .1, 0, .3, .2, 1, -.9, .4, 0, 0, .1, .05, .04, 0, .3, 0, .2, 3, .1, .1, 0, 0, .2, .5;
  return a * a.transpose() + 0.001 * SoilMatrix::Identity();
}

TEST(TruncatedGaussian, EveryDrawLiesWithinBounds) {
  // Property: draws lie in the box, also if the mean is far outside.
  for (const double mean : {0.5, -40.0, 900.0}) {
    const TruncatedGaussian g(SoilVector::Constant(mean), correlated(), kUnit);
    const auto points = evenPoints(kSoilParameters, 200);
    for (int k = 0; k < 200; ++k) {
      const auto [at, log_density] = g.draw(points.col(k));
      EXPECT_GE(at.minCoeff(), -1e-9);
      EXPECT_LE(at.maxCoeff(), 1.0 + 1e-9);
      EXPECT_TRUE(std::isfinite(log_density));
    }
  }
}

TEST(TruncatedGaussian, InverseDensityIntegratesToTheBoxVolume) {
  // Property: the mean of 1/density over draws is the volume of the box, 1 (4000 even points: 5 %).
  const TruncatedGaussian g(SoilVector::Constant(0.4), 0.3 * SoilMatrix::Identity(), kUnit);
  const auto points = evenPoints(kSoilParameters, 4000);
  double volume = 0.0;
  for (int k = 0; k < 4000; ++k) volume += std::exp(-g.draw(points.col(k)).log_density) / 4000.0;
  EXPECT_NEAR(volume, 1.0, 0.05);
}

TEST(TruncatedGaussian, WithoutBoundsItIsTheGaussian) {
  // Closed form: the density of the untruncated Gaussian at the draw.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TruncatedGaussian g(SoilVector::Zero(), SoilMatrix::Identity(),
                            {SoilVector::Constant(-kInfinity), SoilVector::Constant(kInfinity)});
  const auto [at, log_density] = g.draw(SoilVector::Constant(0.3));
  EXPECT_NEAR(log_density, -0.5 * at.squaredNorm() - 2.5 * std::log(2.0 * std::numbers::pi), 1e-9);
}

}  // namespace truncated_gaussian_test
}  // namespace talus::terramech
