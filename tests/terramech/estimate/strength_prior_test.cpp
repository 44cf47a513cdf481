#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/terramech/estimate/strength_prior.hpp>

namespace talus::terramech {
namespace strength_prior_test {

ShearStrength fitOf(double cohesion_Pa, double tan_friction, const Eigen::Vector2d& std, double correlation) {
  ShearStrength fit{.cohesion_Pa = cohesion_Pa, .tan_friction = tan_friction};
  const double both = correlation * std[0] * std[1];
  fit.covariance << std[0] * std[0], both, both, std[1] * std[1];
  fit.samples = 10;
  fit.unseen = {"cohesion_Pa: far"};
  return fit;
}

StrengthPrior priorOf(double cohesion_Pa, double tan_friction, const Eigen::Vector2d& std,
                      double probability = 1.0) {
  return {.mean = {cohesion_Pa, tan_friction},
          .covariance = std.cwiseAbs2().asDiagonal(),
          .probability = probability};
}

double normal(double away, double variance) {
  return std::exp(-0.5 * away * away / variance) / std::sqrt(variance);
}

TEST(StrengthPrior, MatchesIntegrationOverAGrid) {
  // Property: the result equals mean and covariance of prior times likelihood, summed over a fine grid of
  // (c, tan phi).
  const ShearStrength fit = fitOf(2200.0, 0.52, {900.0, 0.09}, -0.8);
  const std::vector<StrengthPrior> priors{priorOf(1000.0, 0.6, {400.0, 0.05}, 0.7),
                                          priorOf(4000.0, 0.4, {800.0, 0.04}, 0.3)};
  double sum = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const Eigen::Matrix2d inverse = fit.covariance.inverse();
  for (double c = -3000.0; c < 9000.0; c += 40.0) {
    for (double t = 0.0; t < 1.1; t += 0.004) {
      const Eigen::Vector2d away(c - 2200.0, t - 0.52);
      double density = 0.0;
      for (const StrengthPrior& p : priors)
        density += p.probability * normal(c - p.mean[0], p.covariance(0, 0)) *
                   normal(t - p.mean[1], p.covariance(1, 1));
      const double weight = density * std::exp(-0.5 * away.dot(inverse * away));
      sum += weight;
      mean += weight * away;
      squares += weight * away * away.transpose();
    }
  }
  mean /= sum;
  const Eigen::Matrix2d covariance = squares / sum - mean * mean.transpose();
  const ShearStrength result = withPrior(fit, priors);
  EXPECT_NEAR(result.cohesion_Pa, 2200.0 + mean[0], 1.0);
  EXPECT_NEAR(result.tan_friction, 0.52 + mean[1], 1e-4);
  EXPECT_NEAR(result.covariance(0, 0) / covariance(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(result.covariance(1, 1) / covariance(1, 1), 1.0, 1e-3);
  EXPECT_NEAR(result.covariance(0, 1) / covariance(0, 1), 1.0, 1e-3);
  EXPECT_EQ(result.unseen, fit.unseen);
}

TEST(StrengthPrior, FixedValuesAreKeptAndVaguePriorHasNoEffect) {
  const ShearStrength fit = fitOf(2200.0, 0.52, {900.0, 0.09}, -0.8);
  const std::vector<StrengthPrior> known{priorOf(1000.0, 0.6, {0.0, 0.0})};
  EXPECT_DOUBLE_EQ(withPrior(fit, known).cohesion_Pa, 1000.0);
  EXPECT_NEAR(withPrior(fit, known).covariance.norm(), 0.0, 1e-9);
  const std::vector<StrengthPrior> vague{priorOf(0.0, 0.0, {1e8, 1e4})};
  EXPECT_NEAR(withPrior(fit, vague).cohesion_Pa, 2200.0, 0.1);
  EXPECT_NEAR(withPrior(fit, vague).tan_friction, 0.52, 1e-5);
}

TEST(StrengthPrior, ExactReadingsOverridePriorWithNonZeroStd) {
  const ShearStrength fit = fitOf(2200.0, 0.52, {0.0, 0.0}, 0.0);
  const std::vector<StrengthPrior> prior{priorOf(1000.0, 0.6, {400.0, 0.05})};
  EXPECT_NEAR(withPrior(fit, prior).cohesion_Pa, 2200.0, 0.1);
}

TEST(StrengthPrior, ConvertsAngleStdToTangentStd) {
  // Closed form: d tan(phi) = d phi / cos(phi)^2, at 45 deg twice as wide.
  SoilPrior soil{.mean = {.name = "x", .cohesion_Pa = 500.0, .friction_angle_rad = std::atan(1.0)},
                 .deviation = {.cohesion_Pa = 100.0, .friction_angle_rad = 0.03}};
  const StrengthPrior prior = strengthPrior(soil);
  EXPECT_NEAR(prior.mean[1], 1.0, 1e-12);
  EXPECT_NEAR(prior.covariance(1, 1), 0.06 * 0.06, 1e-12);
  EXPECT_NEAR(prior.covariance(0, 0), 1e4, 1e-9);
}

TEST(StrengthPrior, FitWithoutCovarianceAndEmptyPriorAreRejected) {
  ShearStrength two = fitOf(1.0, 0.5, {1.0, 1.0}, 0.0);
  two.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<StrengthPrior> prior{priorOf(1000.0, 0.6, {400.0, 0.05})};
  EXPECT_REFUSED(withPrior(two, prior), std::domain_error,
                 "at least three samples are required to estimate the scatter");
  EXPECT_REFUSED(withPrior(fitOf(1.0, 0.5, {1.0, 1.0}, 0.0), {}), std::invalid_argument, "no kind of soil");
}

}  // namespace strength_prior_test
}  // namespace talus::terramech
