#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include <talus/terramech/strength/plate_trials.hpp>

namespace talus::terramech {
namespace plate_trials_test {

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
  PressureSinkageFit pooled;
  for (const double k : {1e6, 2e6, 4e6}) {
    trials.push_back(trial("", k, 1.2, 0.002, 0.03 * 1e6 / k));
    for (const PlateReading& r : trials.back().readings) pooled.add(r);
  }
  const auto soils = trialSoils(trials);
  ASSERT_EQ(soils.size(), 1U);
  EXPECT_EQ(soils[0].trials, 3U);
  EXPECT_NEAR(soils[0].fit.sinkage_exponent, 1.2, 1e-9);
  EXPECT_NEAR(soils[0].exponent.spread, 0.0, 1e-6);
  EXPECT_LT(pooled.estimate().sinkage_exponent, 0.8);
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
  PressureSinkageFit fit;
  for (const PlateReading& r : one.readings) fit.add(r);
  const TrialSoil soil = trialSoils(std::vector{one}).at(0);
  EXPECT_NEAR(soil.fit.sinkage_exponent, fit.estimate().sinkage_exponent, 1e-12);
  EXPECT_NEAR(soil.fit.plates.at(0).sinkage_modulus / fit.estimate().plates.at(0).sinkage_modulus, 1.0, 1e-9);
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

}  // namespace plate_trials_test
}  // namespace talus::terramech
