#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

namespace bevameter_test {

PressureSinkageFit pressed(std::initializer_list<double> widths, double noise = 0.0) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  PressureSinkageFit fit;
  for (const double b : widths) {
    for (int i = 1; i <= 400; ++i) {
      const double z = 1e-4 * i;
      fit.add({b, z, (13190.0 / b + 692150.0) * std::pow(z, 0.5) * (1.0 + noise * normal(random))});
    }
  }
  return fit;
}

TEST(PressureSinkageFit, RecoversTheSoilOfExactReadings) {
  // Printed in: thesis Table A.1, clayey soil: n = 0.5, k_c = 13.19, k_phi = 692.15 (kN).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2}).estimate();
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 1e-12);
  ASSERT_TRUE(fit.cohesive_modulus && fit.frictional_modulus);
  EXPECT_NEAR(*fit.cohesive_modulus, 13190.0, 1e-5);
  EXPECT_NEAR(*fit.frictional_modulus, 692150.0, 1e-4);
  EXPECT_LT(fit.residual_std, 1e-7);
}

TEST(PressureSinkageFit, ModuliAreNotSeparatedForOneOrSimilarPlateWidths) {
  for (const auto& fit : {pressed({0.05}).estimate(), pressed({0.05, 0.055}).estimate()}) {
    EXPECT_FALSE(fit.cohesive_modulus);
    EXPECT_FALSE(fit.frictional_modulus);
    EXPECT_THAT(fit.refused, testing::HasSubstr("not identifiable separately"));
    EXPECT_NEAR(fit.plates.front().sinkage_modulus, 13190.0 / 0.05 + 692150.0, 1e-4);
  }
}

TEST(PressureSinkageFit, ResidualStdEqualsTheAddedNoise) {
  // Property: 5 % noise on each pressure gives a residual standard deviation of 0.05 (1200 readings: +- 4 %,
  // two standard deviations).
  const PressureSinkage fit = pressed({0.05, 0.1, 0.2}, 0.05).estimate();
  EXPECT_NEAR(fit.residual_std, 0.05, 0.002);
  EXPECT_NEAR(fit.sinkage_exponent, 0.5, 0.01);
}

TEST(PressureSinkageFit, MinimisesWongsCriterion) {
  // Property: any change of the result increases the sum of sigma^2 (ln sigma - ln k - n ln z)^2
  // (wong_1980).
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  PressureSinkageFit fitter;
  std::vector<PlateReading> readings;
  for (int i = 1; i <= 40; ++i) {
    const double z = 1e-3 * i;
    readings.push_back({0.1, z, 8e5 * std::pow(z, 0.7) * (1.0 + 0.2 * normal(random))});
    fitter.add(readings.back());
  }
  const PressureSinkage fit = fitter.estimate();
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
  PressureSinkageFit fit;
  EXPECT_REFUSED(fit.add({0.05, 0.0, 1000.0}), std::invalid_argument, "sinkage_m = 0, must be > 0");
  EXPECT_REFUSED(fit.add({0.05, 0.01, std::nan("")}), std::invalid_argument,
                 "pressure_Pa = nan, must be finite");
  fit.add({0.05, 0.01, 1000.0});
  EXPECT_REFUSED(fit.estimate(), std::domain_error, "n is identifiable only with two depths per plate");
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

}  // namespace bevameter_test

}  // namespace talus::terramech
