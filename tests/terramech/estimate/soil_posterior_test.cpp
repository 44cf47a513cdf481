#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <refused.hpp>
#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/numerics/functions.hpp>

#include "exact_likelihood.hpp"

namespace talus::terramech {
namespace soil_posterior_test {

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

TEST(SoilMixture, ThesisSoilsSpanTable21) {
  // Printed in: thesis Table 2.1.
  const SoilMixture soils = thesisSoils();
  ASSERT_EQ(soils.size(), 4u);
  const ContactSoil clay = soils[1].at(SoilVector::Zero());
  EXPECT_NEAR(clay.cohesion_Pa, 5000.0, 1e-9);
  EXPECT_NEAR(clay.friction_angle_rad / kDegree, 20.0, 1e-9);
  EXPECT_NEAR(clay.sinkage_exponent, 0.5, 1e-12);
  const ContactSoil firm = soils[3].at(SoilVector::Ones());
  EXPECT_NEAR(firm.sinkage_modulus, 3e6, 1e-3);
  EXPECT_NEAR(firm.shear_modulus_m, 0.03, 1e-12);
}

TEST(SoilMixture, ProbabilitiesSumToOne) {
  double sum = 0.0;
  for (const SoilClass& soil : thesisSoilsOrOther(0.1)) sum += soil.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Marginal, SlopeIsTheDerivative) {
  // Property: slope() equals central differences.
  for (const Marginal& m :
       {Marginal::uniform(2.0, 5.0), Marginal::logUniform(0.1, 10.0), Marginal::normal(1.0, 0.3, 0.0)}) {
    for (const double y : {0.2, 0.5, 0.9}) {
      EXPECT_NEAR((m.at(y + 1e-6) - m.at(y - 1e-6)) / 2e-6, m.slope(y), 1e-6 * (1.0 + m.slope(y)));
    }
  }
}

TEST(Marginal, FixedIsConstantAndNormalIsBoundedBelow) {
  EXPECT_EQ(Marginal::fixed(3.0).at(0.9), 3.0);
  EXPECT_EQ(Marginal::fixed(3.0).slope(0.9), 0.0);
  EXPECT_EQ(Marginal::normal(1.0, 1.0, 0.0).at(-5.0), 0.0);
  EXPECT_EQ(Marginal::normal(1.0, 1.0, 0.0).slope(-5.0), 0.0);
}

TEST(Marginal, InvalidBoundsAreRejected) {
  EXPECT_REFUSED(Marginal::uniform(2.0, 2.0), std::invalid_argument, "upper bound = 2, must be > 2");
  EXPECT_REFUSED(Marginal::logUniform(0.0, 2.0), std::invalid_argument, "lower bound = 0, must be > 0");
  EXPECT_REFUSED(Marginal::normal(0.0, 0.0, -1.0), std::invalid_argument, "std = 0, must be > 0");
}

TEST(SoilPosterior, MatchesImportanceSamplingFromThePrior) {
  // Property: means, standard deviations and class probabilities equal those of draws from the prior,
  // weighted by the likelihood, within the sampling error. Three readings are used, so that enough draws
  // have weight.
  ThesisRuns runs(17);
  for (int k = 0; k < 2; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = 2});
    SoilMixture prior = thesisSoils();
    for (SoilClass& soil : prior) soil.parameters[kExponent] = Marginal::fixed(run.soil.sinkage_exponent);
    constexpr int kDraws = 3000;
    const Eigen::MatrixXd points = evenPoints(kSoilParameters, kDraws);
    std::array<double, 4> of_class{};
    double sum = 0.0, c = 0.0, cc = 0.0, phi = 0.0, phi2 = 0.0;
    for (std::size_t m = 0; m < prior.size(); ++m) {
      for (int d = 0; d < kDraws; ++d) {
        const ContactSoil soil = prior[m].at(points.col(d));
        double weight = 1.0;
        for (const WheelSample& s : run.samples) weight *= exactLikelihood(soil, s, 0.05);
        sum += weight, of_class[m] += weight;
        c += weight * soil.cohesion_Pa, cc += weight * std::pow(soil.cohesion_Pa, 2);
        phi += weight * soil.friction_angle_rad, phi2 += weight * std::pow(soil.friction_angle_rad, 2);
      }
    }
    const SoilPosterior p = fitSoil(kThesisWheel, run.samples, prior);
    const double c_std = std::sqrt(cc / sum - std::pow(c / sum, 2));
    const double phi_std = std::sqrt(phi2 / sum - std::pow(phi / sum, 2));
    EXPECT_NEAR(p.mean.cohesion_Pa, c / sum, 0.1 * c_std);
    EXPECT_NEAR(p.mean.friction_angle_rad, phi / sum, 0.1 * phi_std);
    EXPECT_NEAR(std::sqrt(p.covariance(0, 0)) / c_std, 1.0, 0.15);
    EXPECT_NEAR(std::sqrt(p.covariance(1, 1)) / phi_std, 1.0, 0.15);
    for (std::size_t m = 0; m < prior.size(); ++m)
      EXPECT_NEAR(p.class_probabilities[m], of_class[m] / sum, 0.05);
  }
}

TEST(SoilPosterior, EllipseCoverageIs95PercentIncludingTruncatedClasses) {
  // Property: the ellipse at the stated level contains the truth in 90 to 99 of 100 cases. (At chi-squared
  // 5.99 the ellipse would contain the whole box of a class.)
  ThesisRuns runs(41);
  int held = 0, held_by_chi_squared = 0;
  for (int k = 0; k < 100; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05});
    const SoilPosterior p = fitSoil(
        kThesisWheel, run.samples, {thesisSoils()[static_cast<std::size_t>(run.soil_class)]}, {.draws = 128});
    held += strengthDistance(p, run.soil) < p.ellipse_95;
    held_by_chi_squared += strengthDistance(p, run.soil) < 5.99;
  }
  EXPECT_GE(held, 90);
  EXPECT_LE(held, 99);
  EXPECT_GE(held_by_chi_squared, 97);
}

TEST(SoilPosterior, FixedParametersDoNotContributeToDistance) {
  ThesisRuns runs(42);
  const ThesisRun run = runs.next({.noise = 0.05});
  SoilMixture prior = thesisSoils();
  for (SoilClass& soil : prior) soil.parameters[kCohesion] = Marginal::fixed(1000.0);
  const SoilPosterior p = fitSoil(kThesisWheel, run.samples, prior);
  ContactSoil other = p.mean;
  other.cohesion_Pa = 5000.0;
  other.friction_angle_rad = std::atan(p.tan_friction + std::sqrt(p.strength_covariance(1, 1)));
  EXPECT_NEAR(strengthDistance(p, other), 1.0, 1e-6);  // Closed form: one standard deviation of tan(phi)
}

TEST(SoilPosterior, ExactReadingsRecoverTheSoil) {
  // Property: with exact readings and assumed errors of 0.1 %, c is within 0.1 kPa and phi within 0.5 deg
  // (worst of eight soils).
  ThesisRuns runs(5);
  for (int k = 0; k < 8; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    const auto p =
        fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = ReadingErrors::relative(1e-3)});
    EXPECT_NEAR(p.mean.cohesion_Pa, run.soil.cohesion_Pa, 200.0);
    EXPECT_NEAR(p.mean.friction_angle_rad, run.soil.friction_angle_rad, 0.5 * kDegree);
    EXPECT_NEAR(p.mean.shear_modulus_m, run.soil.shear_modulus_m, 0.001);
    EXPECT_GT(p.class_probabilities[static_cast<std::size_t>(run.soil_class)], 0.5);
    EXPECT_LT(p.misfit, 1.0);
  }
}

TEST(SoilPosterior, BeatsThePriorMeanAndIsCalibrated) {
  // Property: over 60 soils with 5 % errors the RMS error is below that of the prior mean (2.3 kPa, 4.9 deg)
  // and within a third of the posterior standard deviation; 95 % intervals contain the truth in 85 to 100 %.
  ThesisRuns runs(9);
  double c2 = 0.0, phi2 = 0.0, own_c2 = 0.0, own_phi2 = 0.0;
  int inside = 0;
  constexpr int kSoils = 60;
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05});
    const SoilPosterior p = fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = {}, .draws = 64});
    c2 += std::pow(p.mean.cohesion_Pa - run.soil.cohesion_Pa, 2) / kSoils;
    phi2 += std::pow(p.mean.friction_angle_rad - run.soil.friction_angle_rad, 2) / kSoils;
    own_c2 += p.covariance(0, 0) / kSoils;
    own_phi2 += p.covariance(1, 1) / kSoils;
    inside += run.soil.cohesion_Pa >= p.cohesion_Pa.low && run.soil.cohesion_Pa <= p.cohesion_Pa.high;
  }
  EXPECT_LT(std::sqrt(c2), 1900.0);
  EXPECT_LT(std::sqrt(phi2), 4.4 * kDegree);
  EXPECT_NEAR(std::sqrt(c2 / own_c2), 1.0, 0.33);
  EXPECT_NEAR(std::sqrt(phi2 / own_phi2), 1.0, 0.33);
  EXPECT_GE(inside, 51);
}

TEST(SoilPosterior, IntervalsExcludeTwoPointFivePercentPerSide) {
  // Property: quantiles of the weighted draws, to the weight of the heaviest draw.
  ThesisRuns runs(43);
  const ThesisRun run = runs.next({.noise = 0.05});
  const SoilPosterior p = fitSoil(kThesisWheel, run.samples, thesisSoils());
  double below = 0.0, above = 0.0, heaviest = 0.0;
  for (const SoilDraw& d : p.draws) {
    if (d.soil.cohesion_Pa < p.cohesion_Pa.low) below += d.weight;
    if (d.soil.cohesion_Pa > p.cohesion_Pa.high) above += d.weight;
    heaviest = std::max(heaviest, d.weight);
  }
  EXPECT_LT(heaviest, 0.015);
  EXPECT_NEAR(below, 0.025, heaviest);
  EXPECT_NEAR(above, 0.025, heaviest);
}

TEST(SoilPosterior, OneOutlierMovesTheMeanByLessThanOneStd) {
  // Property: one torque read at twice its value changes the result by less than its standard deviation.
  ThesisRuns runs(21);
  ThesisRun run = runs.next({.noise = 0.02});
  const SoilFitOptions options{.noise = ReadingErrors::relative(0.02)};
  const SoilPosterior clean = fitSoil(kThesisWheel, run.samples, thesisSoils(), options);
  run.samples[4].torque_Nm *= 2.0;
  const SoilPosterior dirty = fitSoil(kThesisWheel, run.samples, thesisSoils(), options);
  EXPECT_LT(std::abs(dirty.mean.cohesion_Pa - clean.mean.cohesion_Pa),
            std::sqrt(clean.covariance(0, 0)) + 100.0);
  EXPECT_LT(std::abs(dirty.mean.friction_angle_rad - clean.mean.friction_angle_rad),
            std::sqrt(clean.covariance(1, 1)) + 0.5 * kDegree);
}

TEST(SoilPosterior, FindsASoilFarFromThePriorCentre) {
  // Property: the soil is found, although with errors of 1 % every sample is an outlier at the prior mean.
  ThesisRuns runs(14);
  const ThesisRun run = runs.next({.noise = 0.01});
  const SoilMixture wide{thesisSoilsOrOther(0.5).back()};
  SoilFitOptions options;
  options.noise = ReadingErrors::relative(0.01);
  const SoilPosterior p = fitSoil(kThesisWheel, run.samples, wide, options);
  EXPECT_LT(p.misfit, 3.0);
  EXPECT_NEAR(p.mean.sinkage_exponent, run.soil.sinkage_exponent, 4.0 * std::sqrt(p.covariance(2, 2)) + 0.02);
}

TEST(SoilPosterior, ReportsParametersUnidentifiableFromRepeatedSamples) {
  // Property: twelve samples at slip 0.8, where the shear stress is nearly developed, leave K poorly
  // determined.
  ThesisRuns runs(2);
  ThesisRun run = runs.next({.noise = 0.05});
  const std::vector<WheelSample> same(3, run.samples[6]);
  const SoilPosterior p = fitSoil(kThesisWheel, same, thesisSoils());
  EXPECT_THAT(p.unseen, testing::Contains(testing::StartsWith("shear_modulus_m: ")));
}

TEST(SoilPosterior, IsDeterministic) {
  ThesisRuns runs(4);
  const ThesisRun run = runs.next({.noise = 0.05});
  const auto once = fitSoil(kThesisWheel, run.samples, thesisSoils());
  const auto again = fitSoil(kThesisWheel, run.samples, thesisSoils());
  EXPECT_EQ(once.mean.cohesion_Pa, again.mean.cohesion_Pa);
  EXPECT_EQ(once.strength_covariance, again.strength_covariance);
}

TEST(SoilPosterior, BrakedAndBuriedWheelsAreRejected) {
  const WheelSample good{.load_N = 80, .torque_Nm = 3, .sinkage_m = 0.02, .slip = 0.4};
  WheelSample braked = good;
  braked.slip = -0.1;
  WheelSample buried = good;
  buried.sinkage_m = 0.15;
  EXPECT_REFUSED(fitSoil(kThesisWheel, std::vector{braked}, thesisSoils()), std::invalid_argument,
                 "slip = -0.1, must be in [0, 1]");
  EXPECT_REFUSED(fitSoil(kThesisWheel, std::vector{buried}, thesisSoils()), std::invalid_argument,
                 "sinkage_m = 0.15, must be in [0, 0.1]");
  EXPECT_REFUSED(fitSoil(kThesisWheel, std::vector<WheelSample>{}, thesisSoils()), std::domain_error,
                 "no sample, or no class of soil");
}

TEST(SoilFilter, EqualsTheBatchEstimateWithinTheWindow) {
  // Property: filter and batch fit have the same modes within the tolerance of the search, and therefore
  // almost equal draws.
  ThesisRuns runs(8);
  const ThesisRun run = runs.next({.noise = 0.05});
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, thesisSoils());
  EXPECT_NEAR(filter.posterior().mean.cohesion_Pa, batch.mean.cohesion_Pa,
              0.15 * std::sqrt(batch.covariance(0, 0)));
  EXPECT_NEAR(filter.posterior().mean.friction_angle_rad, batch.mean.friction_angle_rad,
              0.15 * std::sqrt(batch.covariance(1, 1)));
}

TEST(SoilFilter, MatchesTheBatchEstimateBeyondTheWindow) {
  // Property: with 40 samples, 12 of them kept, the result is within half a standard deviation of the fit of
  // all 40.
  ThesisRuns runs(12);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 40});
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, thesisSoils());
  const SoilPosterior p = filter.posterior();
  EXPECT_NEAR(p.mean.cohesion_Pa, batch.mean.cohesion_Pa, 0.5 * std::sqrt(batch.covariance(0, 0)) + 50.0);
  EXPECT_NEAR(p.mean.sinkage_exponent, batch.mean.sinkage_exponent,
              0.5 * std::sqrt(batch.covariance(2, 2)) + 0.01);
  EXPECT_EQ(filter.samples(), 40u);
}

TEST(SoilFilter, RejectedSampleLeavesTheStateUnchanged) {
  ThesisRuns runs(3);
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : runs.next({.noise = 0.05}).samples) filter.add(s);
  const double before = filter.posterior().mean.cohesion_Pa;
  EXPECT_THROW(filter.add({.load_N = -1.0, .torque_Nm = 1.0, .sinkage_m = 0.01, .slip = 0.3}),
               std::invalid_argument);
  EXPECT_EQ(filter.posterior().mean.cohesion_Pa, before);
  EXPECT_EQ(filter.samples(), 10u);
}

TEST(SoilFilter, SinkageExponentHasNoBiasOverManySamples) {
  // Property: over eight runs of sixty samples the mean departure of n from the batch fit is below 0.3
  // standard deviations. Without the slope of the normalisation n is 0.7 too low.
  ThesisRuns runs(44);
  double departure = 0.0;
  for (int k = 0; k < 8; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = 60});
    const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
    SoilFilter filter(kThesisWheel, known, {});
    for (const WheelSample& s : run.samples) filter.add(s);
    const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, known);
    departure += (filter.posterior().mean.sinkage_exponent - batch.mean.sinkage_exponent) /
                 std::sqrt(batch.covariance(kExponent, kExponent)) / 8.0;
  }
  EXPECT_NEAR(departure, 0.0, 0.3);
}

TEST(SoilFilter, RetainsInformationOfSamplesOutsideTheWindow) {
  // Property: sixty samples on a known class give smaller standard deviations of phi and K than the last
  // twelve alone.
  ThesisRuns runs(44);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 60});
  const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
  SoilFilter filter(kThesisWheel, known, {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const auto all = filter.posterior().covariance;
  const auto window = fitSoil(kThesisWheel, std::span(run.samples).last(12), known).covariance;
  EXPECT_LT(all(kShear, kShear), 0.5 * window(kShear, kShear));
  EXPECT_LT(all(kFriction, kFriction), 0.5 * window(kFriction, kFriction));
}

}  // namespace soil_posterior_test
}  // namespace talus::terramech
