#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/LU>
#include <error_minimisation.hpp>
#include <gtest/gtest.h>
#include <linear_offset_stresses.hpp>
#include <refused.hpp>
#include <thesis_runs.hpp>

#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

#include "linear_world.hpp"

namespace talus::terramech {
namespace strength_test {

PressureSinkage pressed(std::initializer_list<double> widths, double noise = 0.0) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<PlateReading> readings;
  for (const double b : widths) {
    for (int i = 1; i <= 400; ++i) {
      const double z = 1e-4 * i;
      readings.push_back(
          {b, z, (13190.0 / b + 692150.0) * std::pow(z, 0.5) * (1.0 + noise * normal(random))});
    }
  }
  return fitPressureSinkage(readings);
}

TEST(PressureSinkageFit, RecoversTheSoilOfExactReadings) {
  // Printed in: thesis Table A.1, clayey soil: n = 0.5, k_c = 13.19, k_phi = 692.15 (kN).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2});
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 1e-12);
  ASSERT_TRUE(fit.cohesive_modulus && fit.frictional_modulus);
  EXPECT_NEAR(*fit.cohesive_modulus, 13190.0, 1e-5);
  EXPECT_NEAR(*fit.frictional_modulus, 692150.0, 1e-4);
  EXPECT_LT(fit.residual_std, 1e-7);
}

TEST(PressureSinkageFit, ModuliAreNotSeparatedForOneOrSimilarPlateWidths) {
  for (const auto& fit : {pressed({0.05}), pressed({0.05, 0.055})}) {
    EXPECT_FALSE(fit.cohesive_modulus);
    EXPECT_FALSE(fit.frictional_modulus);
    EXPECT_THAT(fit.refused, testing::HasSubstr("not identifiable separately"));
    EXPECT_NEAR(fit.plates.front().sinkage_modulus, 13190.0 / 0.05 + 692150.0, 1e-4);
  }
}

TEST(PressureSinkageFit, ResidualStdEqualsTheAddedNoise) {
  // Property: 5 % noise on each pressure gives a residual standard deviation of 0.05 (1200 readings: +- 4 %,
  // two standard deviations).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2}, 0.05);
  EXPECT_NEAR(fit.residual_std, 0.05, 0.002);
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 0.01);
}

TEST(PressureSinkageFit, MinimisesWongsCriterion) {
  // Property: any change of the result increases the sum of sigma^2 (ln sigma - ln k - n ln z)^2
  // (wong_1980).
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  std::vector<PlateReading> readings;
  for (int i = 1; i <= 40; ++i) {
    const double z = 1e-3 * i;
    readings.push_back({0.1, z, 8e5 * std::pow(z, 0.7) * (1.0 + 0.2 * normal(random))});
  }
  const PressureSinkage fit = fitPressureSinkage(readings);
  const auto cost = [&](double k, double n) {
    double sum = 0.0;
    for (const PlateReading& r : readings) {
      const double away = std::log(r.pressure_Pa) - std::log(k) - n * std::log(r.sinkage_m);
      sum += r.pressure_Pa * r.pressure_Pa * away * away;
    }
    return sum;
  };
  const double k = fit.plates.front().sinkage_modulus, n = fit.sinkage_exponent;
  for (const double step : {-0.001, 0.001}) {
    EXPECT_GT(cost(k * (1.0 + step), n), cost(k, n));
    EXPECT_GT(cost(k, n + step), cost(k, n));
  }
}

TEST(PressureSinkageFit, InvalidReadingsAreRejected) {
  const auto fit = [](double sinkage_m, double pressure_Pa) {
    return fitPressureSinkage(std::vector<PlateReading>{{0.05, sinkage_m, pressure_Pa}});
  };
  EXPECT_REFUSED(fit(0.0, 1000.0), std::invalid_argument, "sinkage_m = 0, must be > 0");
  EXPECT_REFUSED(fit(0.01, std::nan("")), std::invalid_argument, "pressure_Pa = nan, must be finite");
  EXPECT_REFUSED(fit(0.01, 1000.0), std::domain_error, "n is identifiable only with two depths per plate");
}

std::vector<ShearReading> sheared(double modulus, double furthest_m) {
  std::vector<ShearReading> readings;
  for (const double sigma : {5000.0, 10000.0, 20000.0}) {
    for (int i = 1; i <= 15; ++i) {
      const double j = furthest_m * i / 15.0;
      readings.push_back({sigma, (740.0 + sigma * 0.62) * (1.0 - std::exp(-j / modulus)), j});
    }
  }
  return readings;
}

TEST(FitShear, RecoversCohesionFrictionAndModulusOfExactReadings) {
  // Closed form: Eq. A.4.
  const ShearFit fit = fitShear(sheared(0.013, 0.05));
  EXPECT_NEAR(fit.shear_modulus_m, 0.013, 1e-8);
  EXPECT_NEAR(fit.strength.cohesion_Pa, 740.0, 1e-2);
  EXPECT_NEAR(fit.strength.tan_friction, 0.62, 1e-6);
  EXPECT_FALSE(fit.modulus_at_bound);
}

TEST(FitShear, MinimisesTheSquaredStressResiduals) {
  // Property: any change of the result increases the sum of squares of tau - (c + sigma t)(1 - e^(-j/K)).
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  auto readings = sheared(0.013, 0.05);
  for (ShearReading& r : readings) r.shear_Pa *= 1.0 + 0.05 * normal(random);
  const ShearFit fit = fitShear(readings);
  const auto cost = [&](double c, double t, double k) {
    double sum = 0.0;
    for (const ShearReading& r : readings)
      sum += std::pow(r.shear_Pa - (c + r.normal_Pa * t) * (1.0 - std::exp(-r.displacement_m / k)), 2);
    return sum;
  };
  const double c = fit.strength.cohesion_Pa, t = fit.strength.tan_friction, k = fit.shear_modulus_m;
  for (const double step : {-0.01, 0.01}) {
    EXPECT_GT(cost(c * (1.0 + step), t, k), cost(c, t, k));
    EXPECT_GT(cost(c, t * (1.0 + step), k), cost(c, t, k));
    EXPECT_GT(cost(c, t, k * (1.0 + step)), cost(c, t, k));
  }
}

TEST(FitShear, SingleNormalStressIsRejected) {
  EXPECT_REFUSED(fitShear(std::vector<ShearReading>(5, {1e4, 6e3, 0.05})), std::domain_error,
                 "all samples have the same normal stress");
}

/// sigma = k z^n from z_low to z_high, without noise.
PlateTrial trial(const std::string& soil, double k, double n, double z_low, double z_high,
                 double width_m = 0.04) {
  PlateTrial t{.soil = soil, .name = {}, .readings = {}};
  for (int i = 0; i <= 50; ++i) {
    const double z = z_low + (z_high - z_low) * i / 50.0;
    t.readings.push_back({width_m, z, k * std::pow(z, n)});
  }
  return t;
}

TEST(PlateTrials, ExponentIsFittedWithinTrialsOfDifferentModulus) {
  // Closed form: every trial has n = 1.2; firm trials are shallow, so that a fit of pooled readings has a
  // smaller n.
  std::vector<PlateTrial> trials;
  std::vector<PlateReading> pooled;
  for (const double k : {1e6, 2e6, 4e6}) {
    trials.push_back(trial("", k, 1.2, 0.002, 0.03 * 1e6 / k));
    for (const PlateReading& r : trials.back().readings) pooled.push_back(r);
  }
  const auto soils = trialSoils(trials);
  ASSERT_EQ(soils.size(), 1U);
  EXPECT_EQ(soils[0].trials, 3U);
  EXPECT_NEAR(soils[0].fit.sinkage_exponent, 1.2, 1e-9);
  EXPECT_NEAR(soils[0].exponent.spread, 0.0, 1e-6);
  EXPECT_LT(fitPressureSinkage(pooled).sinkage_exponent, 0.8);
  // Closed form: ln k of the three trials is 0, ln 2, 2 ln 2: a standard deviation of ln 2.
  EXPECT_NEAR(soils[0].pressure_spread, std::log(2.0), 1e-5);  // tolerance: rounding of the weights of exact
                                                               // trials
  EXPECT_NEAR(soils[0].fit.plates.at(0).sinkage_modulus, 2e6, 1.0);
}

TEST(PlateTrials, EachSoilIsFittedSeparately) {
  const std::vector<PlateTrial> trials{trial("b", 1e6, 1.4, 0.002, 0.03), trial("a", 5e5, 0.7, 0.002, 0.03),
                                       trial("b", 1e6, 1.4, 0.002, 0.02)};
  const auto soils = trialSoils(trials);
  ASSERT_EQ(soils.size(), 2U);
  EXPECT_EQ(soils[0].soil, "b");
  EXPECT_EQ(soils[0].trials, 2U);
  EXPECT_NEAR(soils[0].fit.sinkage_exponent, 1.4, 1e-9);
  EXPECT_NEAR(soils[1].fit.sinkage_exponent, 0.7, 1e-9);
}

TEST(PlateTrials, OneTrialEqualsThePlainFit) {
  const PlateTrial one = trial("", 1e6, 0.9, 0.002, 0.03);
  const PressureSinkage fit = fitPressureSinkage(one.readings);
  const TrialSoil soil = trialSoils(std::vector{one}).at(0);
  EXPECT_NEAR(soil.fit.sinkage_exponent, fit.sinkage_exponent, 1e-12);
  EXPECT_NEAR(soil.fit.plates.at(0).sinkage_modulus / fit.plates.at(0).sinkage_modulus, 1.0, 1e-9);
  EXPECT_EQ(soil.exponent.spread, 0.0);
}

TEST(PlateTrials, TrialWithASingleDepthIsExcluded) {
  PlateTrial one;
  one.readings = {{0.04, 0.01, 1e4}, {0.04, 0.01, 1.1e4}};
  EXPECT_THROW(trialSoils(std::vector{one}), std::domain_error);
  EXPECT_EQ(trialSoils(std::vector{one, trial("", 1e6, 0.9, 0.002, 0.03)}).at(0).trials, 1U);
}

TEST(RandomEffect, RecoversMeanAndSpread) {
  // Property: spread and mean of 400 trials of spread 0.3 with errors of 0.1 are found. Tolerance: 5 % of the
  // spread, three standard errors of the mean.
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<Estimate> values;
  for (int k = 0; k < 400; ++k) values.push_back({2.0 + 0.3 * normal(random) + 0.1 * normal(random), 0.1});
  const RandomEffect r = randomEffect(values);
  EXPECT_NEAR(r.spread, 0.3, 0.1 * 0.3);
  EXPECT_NEAR(r.mean.value, 2.0, 3.0 * r.mean.std);
  EXPECT_NEAR(r.mean.std, std::sqrt(0.1 / 400.0), 0.002);
  // Closed form: equal values have no spread; their mean has the error of 1 / sqrt(sum of 1 / var).
  const std::array<Estimate, 4> equal{{{1.0, 0.2}, {1.0, 0.2}, {1.0, 0.2}, {1.0, 0.2}}};
  EXPECT_EQ(randomEffect(equal).spread, 0.0);
  EXPECT_NEAR(randomEffect(equal).mean.std, 0.1, 1e-9);
}

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

// Samples under the assumptions of D.8: one load, one sinkage, slip from 0.1 to 0.8, no cohesion.
std::vector<WheelSample> steadyRun(double modulus) {
  std::vector<WheelSample> samples;
  for (int k = 1; k <= 8; ++k) {
    const LinearWorld world{.cohesion_Pa = 0.0, .tan_friction = 0.6, .shear_modulus_m = modulus};
    WheelSample s = sampleOf(kWheel, world, {.sinkage_m = 0.015, .slip = 0.1 * k});
    s.load_N = 80.0;
    samples.push_back(s);
  }
  return samples;
}

ShearModulusGrid ladderOver(std::span<const WheelSample> samples, const ShearModulusGrid::Options& options) {
  ShearModulusGrid ladder(kWheel, options);
  for (const WheelSample& s : samples) EXPECT_TRUE(ladder.add(s));
  return ladder;
}

// Samples under the assumptions of App. D.8: one load, one sinkage, no cohesion.

TEST(ShearModulusGrid, JointFitIsAccurateForLinearStresses) {
  const auto samples = linearSamples(kWheel, {.cohesion_Pa = 500.0});
  EXPECT_NEAR(ladderOver(samples, {}).modulus().shear_modulus_m, 0.02, 0.002);
}

TEST(ShearModulusGrid, ErrorMinimisationMatchesTheMethodOfTheThesisWithinGridSpacing) {
  // Property: both criteria have their minimum at the K for which the points lie on a line; there, the points
  // lie on a line except for M1 (6 %).
  const auto samples = linearSamples(kWheel, {.cohesion_Pa = 500.0});
  const auto ladder = ladderOver(samples, {.criterion = ModulusCriterion::ErrorMinimisation});
  const auto least = modulusByErrorMinimisation(kWheel, samples);
  EXPECT_NEAR(least.shear_modulus_m, 0.02, 0.002);
  EXPECT_NEAR(ladder.modulus().shear_modulus_m / least.shear_modulus_m, 1.0, 0.05);
}

TEST(ShearModulusGrid, TorqueRatioIsExactUnderItsAssumptions) {
  for (const double truth : {0.006, 0.02, 0.05}) {
    const auto ladder = ladderOver(steadyRun(truth), {.criterion = ModulusCriterion::TorqueRatio});
    // Tolerance: accuracy of the parabola through values 28 % apart.
    EXPECT_NEAR(ladder.modulus().shear_modulus_m / truth, 1.0, 0.03) << truth;
    EXPECT_FALSE(ladder.modulus().at_bound);
  }
}

TEST(ShearModulusGrid, EffectiveTorqueIsAccurateOnlyAtFullMobilisation) {
  // Property: if A(i_max) is 1, that is for K far below j, both forms of D.8 agree; otherwise the printed
  // form is too low.
  const auto at = [](double truth, ModulusCriterion c) {
    return ladderOver(steadyRun(truth), {.criterion = c}).modulus().shear_modulus_m;
  };
  EXPECT_NEAR(at(0.003, ModulusCriterion::EffectiveTorque) / 0.003, 1.0, 0.05);
  EXPECT_LT(at(0.02, ModulusCriterion::EffectiveTorque), 0.75 * 0.02);
}

TEST(ShearModulusGrid, MaximumSlipSampleIsExcludedFromItsOwnEquation) {
  // Closed form: with the highest slip and one lower slip, sampled three times, K solves A(i) = T/T_max, K = -j
  // / ln(1 - T/T_max) (thesis D.8 as printed).
  const auto run = steadyRun(0.02);
  const std::vector<WheelSample> samples{run[2], run[2], run[2], run.back()};
  const auto ladder = ladderOver(samples, {.criterion = ModulusCriterion::EffectiveTorque});
  const double k =
      -peakShearDisplacement_m(kWheel, run[2]) / std::log1p(-run[2].torque_Nm / run.back().torque_Nm);
  EXPECT_NEAR(ladder.modulus().shear_modulus_m / k, 1.0, 0.05);
}

TEST(ShearModulusGrid, ConstantSlipLeavesTheModulusAtABound) {
  const std::vector<WheelSample> same(5, steadyRun(0.02).front());
  EXPECT_TRUE(ladderOver(same, {.criterion = ModulusCriterion::EffectiveTorque}).modulus().at_bound);
}

TEST(ShearModulusGrid, ResultIsIndependentOfSampleOrder) {
  // Property: the result does not depend on the position of the highest slip.
  const auto samples = steadyRun(0.02);
  const std::vector<WheelSample> back(samples.rbegin(), samples.rend());
  for (const auto c : {ModulusCriterion::EffectiveTorque, ModulusCriterion::TorqueRatio}) {
    EXPECT_NEAR(ladderOver(samples, {.criterion = c}).modulus().shear_modulus_m,
                ladderOver(back, {.criterion = c}).modulus().shear_modulus_m, 1e-12);
  }
}

TEST(ShearModulusGrid, StrengthIsThatOfTheRequestedMethod) {
  // Property: in a world without shear at the bottom, Iagnemma's line at the true K is exact.
  const LinearWorld world{.cohesion_Pa = 1500.0, .offset = false};
  const auto samples = linearSamples(kWheel, world);
  MohrCoulombLine line;
  for (const WheelSample& s : samples) line.add(iagnemmaPair(kWheel, s, world.shear_modulus_m));
  ASSERT_NEAR(line.estimate().cohesion_Pa, 1500.0, 1.0);
  ShearModulusGrid ladder(
      kWheel, {.pair = iagnemmaPair,
               .range = {.low_m = 0.5 * world.shear_modulus_m, .high_m = 2.0 * world.shear_modulus_m}});
  for (const WheelSample& s : samples) ladder.add(s);
  MohrCoulombLine at_k;
  for (const WheelSample& s : samples) at_k.add(iagnemmaPair(kWheel, s, ladder.modulus().shear_modulus_m));
  EXPECT_NEAR(ladder.strength().cohesion_Pa, at_k.estimate().cohesion_Pa, 5.0);
  EXPECT_NEAR(ladder.strength().tan_friction, at_k.estimate().tan_friction, 0.001);
}

TEST(ShearModulusGrid, UnusableSamplesAreSkippedAndFourAreRequired) {
  ShearModulusGrid ladder(kWheel);
  EXPECT_FALSE(ladder.add({.load_N = 80.0, .torque_Nm = -1.0, .sinkage_m = 0.01, .slip = 0.3}));
  EXPECT_FALSE(ladder.add({.load_N = 80.0, .torque_Nm = 2.0, .sinkage_m = 0.01, .slip = -0.3}));
  EXPECT_EQ(ladder.samples(), 0u);
  const auto samples = linearSamples(kWheel, {});
  for (int k = 0; k < 3; ++k) ladder.add(samples[static_cast<std::size_t>(k)]);
  EXPECT_THROW((void)ladder.modulus(), std::domain_error);
  EXPECT_THROW((void)ladder.strength(), std::domain_error);
}

std::vector<StressPair> noisyLine(int count, double spread) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<StressPair> pairs;
  for (int i = 0; i < count; ++i) {
    const double x = 15000.0 * (1.0 + spread * normal(random));
    pairs.push_back({.normal_Pa = x, .shear_Pa = 2000.0 + 0.6 * x + 100.0 * normal(random)});
  }
  return pairs;
}

ShearStrength fitOf(const std::vector<StressPair>& pairs) {
  MohrCoulombLine line;
  for (const StressPair& p : pairs) line.add(p);
  return line.estimate();
}

TEST(MohrCoulombLine, RecursionEqualsTheBatchNormalEquations) {
  // Closed form: Eqs. 2.16 / B.10, (K1' K1)^-1 K1' K2, and s^2 (K1' K1)^-1.
  const auto pairs = noisyLine(40, 0.2);
  Eigen::MatrixX2d k1(pairs.size(), 2);
  Eigen::VectorXd k2(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    k1.row(static_cast<Eigen::Index>(i)) << 1.0, pairs[i].normal_Pa;
    k2[static_cast<Eigen::Index>(i)] = pairs[i].shear_Pa;
  }
  const Eigen::Matrix2d inverse = (k1.transpose() * k1).inverse();
  const Eigen::Vector2d solution = inverse * (k1.transpose() * k2);
  const double variance = (k2 - k1 * solution).squaredNorm() / (static_cast<double>(pairs.size()) - 2.0);
  const ShearStrength fit = fitOf(pairs);
  // Tolerance: the normal equations lose about half the digits, 1e-8 relative.
  EXPECT_NEAR(fit.cohesion_Pa, solution[0], 1e-8 * std::abs(solution[0]));
  EXPECT_NEAR(fit.tan_friction, solution[1], 1e-8);
  EXPECT_LT((fit.covariance - variance * inverse).norm(), 1e-8 * fit.covariance.norm());
  EXPECT_TRUE(fit.unseen.empty());
}

TEST(MohrCoulombLine, CovarianceIsCalibrated) {
  // Property: over repeated noise the error, scaled by its standard deviation, has unit variance (400
  // repeats: +- 10 %).
  double square_c = 0.0;
  double square_t = 0.0;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr int kRepeats = 400;
  for (int k = 0; k < kRepeats; ++k) {
    MohrCoulombLine line;
    for (int i = 0; i < 30; ++i) {
      const double x = 10000.0 + 300.0 * i;
      line.add({.normal_Pa = x, .shear_Pa = 1000.0 + 0.5 * x + 200.0 * normal(random)});
    }
    const ShearStrength fit = line.estimate();
    square_c += std::pow(fit.cohesion_Pa - 1000.0, 2) / fit.covariance(0, 0);
    square_t += std::pow(fit.tan_friction - 0.5, 2) / fit.covariance(1, 1);
  }
  // The ratio follows Student's t with 28 degrees of freedom, whose variance is 28/26.
  EXPECT_NEAR(square_c / kRepeats, 28.0 / 26.0, 0.2);
  EXPECT_NEAR(square_t / kRepeats, 28.0 / 26.0, 0.2);
}

TEST(MohrCoulombLine, WeightTwoEqualsARepeatedSample) {
  // Property: a sample of weight 2 equals two samples.
  MohrCoulombLine weighted;
  MohrCoulombLine repeated;
  for (const StressPair& p : noisyLine(10, 0.1)) {
    weighted.add(p, 2.0);
    repeated.add(p);
    repeated.add(p);
  }
  EXPECT_NEAR(weighted.estimate().cohesion_Pa, repeated.estimate().cohesion_Pa, 1e-6);
  EXPECT_NEAR(weighted.estimate().condition, repeated.estimate().condition, 1e-6);
}

TEST(MohrCoulombLine, ConditionIsThatOfTheScaledMatrix) {
  // Closed form: singular values of [1, x] with unit columns.
  const auto pairs = noisyLine(20, 0.1);
  Eigen::MatrixX2d k1(pairs.size(), 2);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    k1.row(static_cast<Eigen::Index>(i)) << 1.0, pairs[i].normal_Pa;
  }
  k1.col(0).normalize();
  k1.col(1).normalize();
  const double q = k1.col(0).dot(k1.col(1));
  EXPECT_NEAR(fitOf(pairs).condition, std::sqrt((1.0 + q) / (1.0 - q)), 1e-6);
}

TEST(MohrCoulombLine, SimilarSamplesLeaveFrictionAndCohesionUnidentifiable) {
  const ShearStrength fit = fitOf(noisyLine(10, 0.001));
  ASSERT_EQ(fit.unseen.size(), 2u);
  EXPECT_THAT(fit.unseen[0], testing::StartsWith("friction_angle_rad: "));
  EXPECT_THAT(fit.unseen[1], testing::StartsWith("cohesion_Pa: "));
}

TEST(MohrCoulombLine, SingleSampleAndEqualStressesAreRejected) {
  MohrCoulombLine line;
  line.add({.normal_Pa = 1e4, .shear_Pa = 6e3});
  EXPECT_REFUSED(line.estimate(), std::domain_error, "at least two samples are required, got 1");
  line.add({.normal_Pa = 1e4, .shear_Pa = 7e3});
  EXPECT_REFUSED(line.estimate(), std::domain_error, "all samples have the same normal stress");
}

const Wheel kLargeWheel{.radius_m = 0.12, .width_m = 0.09};

ShearStrength estimated(const LinearWorld& world) {
  MohrCoulombLine line;
  for (const WheelSample& s : linearSamples(kLargeWheel, world))
    line.add(iagnemmaPair(kLargeWheel, s, world.shear_modulus_m));
  return line.estimate();
}

TEST(Iagnemma, IsExactIfShearVanishesAtTheBottom) {
  // Property: exact under the method's own assumption, Eq. B.2.
  const ShearStrength fit = estimated({.cohesion_Pa = 1000.0, .tan_friction = 0.6, .offset = false});
  EXPECT_NEAR(fit.cohesion_Pa, 1000.0, 1.0);
  EXPECT_NEAR(fit.tan_friction, 0.6, 1e-4);
}

TEST(Iagnemma, OverestimatesCohesionIfShearActsAtTheBottom) {
  // Property: in a world with shear at the bottom the method overestimates cohesion, the reason for the
  // linear-offset method (thesis Fig. 2.3).
  EXPECT_GT(estimated({.cohesion_Pa = 6000.0, .tan_friction = 0.4}).cohesion_Pa, 7500.0);
}

TEST(Iagnemma, BrakedWheelIsRejected) {
  EXPECT_REFUSED(
      iagnemmaPair(kLargeWheel, {.load_N = 80, .torque_Nm = -1, .sinkage_m = 0.01, .slip = -0.4}, 0.02),
      std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
}

TEST(Sojourner, UniformStressesOverTheChordRecoverTheSoil) {
  // Closed form: W = sigma A, T = r A (c + sigma tan phi) with A = 2 b r sin(theta_1).
  const Wheel wheel{.radius_m = 0.065, .width_m = 0.08};
  MohrCoulombLine line;
  for (const double sigma : {3000.0, 5000.0, 9000.0}) {
    const double z = 0.01;
    const double area = wheel.width_m * 2.0 * wheel.radius_m * std::sin(std::acos(1.0 - z / wheel.radius_m));
    line.add(sojournerPair(wheel, {.load_N = sigma * area,
                                   .torque_Nm = wheel.radius_m * area * (500.0 + 0.7 * sigma),
                                   .sinkage_m = z,
                                   .slip = 1.0}));
  }
  EXPECT_NEAR(line.estimate().cohesion_Pa, 500.0, 1e-9);
  EXPECT_NEAR(line.estimate().tan_friction, 0.7, 1e-12);
}

const Wheel kNarrowWheel{.radius_m = 0.1, .width_m = 0.08};

TEST(LinearOffset, WholeEquationIsExactForLinearStresses) {
  // Property: Eq. 2.9 follows from Eqs. 2.1 to 2.8 without further approximation (only with 2.3 corrected).
  const LinearWorld world{.cohesion_Pa = 5000.0, .tan_friction = 0.45};
  for (const WheelSample& s : linearSamples(kNarrowWheel, world)) {
    const LinearOffsetCoefficients m = linearOffset(kNarrowWheel, s, world.shear_modulus_m);
    const double left = m.m1 * 5000.0 * 0.45 + 5000.0 + m.m3_Pa * 0.45;
    EXPECT_NEAR(left, m.m4_Pa, 1e-5 * m.m4_Pa);  // tolerance: midpoint rule of the samples
  }
}

TEST(LinearOffset, StressesAreRecoveredFromLoadAndTorque) {
  // Property: the estimated stresses equal those of the world.
  const LinearWorld world;
  const WheelSample s = sampleOf(kNarrowWheel, world, {.sinkage_m = 0.02, .slip = 0.5});
  const LinearOffsetStresses stress =
      linearOffsetStresses(kNarrowWheel, s, world.cohesion_Pa, world.shear_modulus_m);
  EXPECT_NEAR(stress.sigma_m_Pa, world.sigma_m_Pa, 1e-5 * world.sigma_m_Pa);
  const double a = mobilisation(kNarrowWheel, s, world.shear_modulus_m).peak;
  EXPECT_NEAR(stress.tau_m_Pa, (world.cohesion_Pa + world.sigma_m_Pa * world.tan_friction) * a, 0.5);
}

TEST(LinearOffset, M1MatchesItsSmallAngleLimit) {
  // Closed form: M1 ~ (theta_1/6) B / (1 + B/2A) > 0 at small contact.
  const WheelSample s{.load_N = 10.0, .torque_Nm = 0.2, .sinkage_m = 1e-6, .slip = 0.5};
  const auto [a, b] = mobilisation(kNarrowWheel, s, 1e-4);
  const double theta_1 = entryAngle_rad(kNarrowWheel, s.sinkage_m);
  EXPECT_NEAR(linearOffset(kNarrowWheel, s, 1e-4).m1 / (theta_1 / 6.0 * b / (1.0 + b / (2.0 * a))), 1.0,
              1e-5);
}

TEST(LinearOffset, WheelWithoutMobilisedShearIsRejected) {
  EXPECT_REFUSED(
      linearOffset(kNarrowWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.01, .slip = -0.5}, 0.02),
      std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
  EXPECT_REFUSED(
      linearOffset(kNarrowWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.0, .slip = 0.5}, 0.02),
      std::invalid_argument, "sinkage_m = 0, must be > 0");
}

}  // namespace strength_test
}  // namespace talus::terramech
