#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/verdict/model_soil.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace model_soil_test {

RefinedModel digging() {
  RefinedModel model;
  model.soil = {.name = "sand",
                .cohesion_Pa = 900.0,
                .friction_angle_rad = 0.52,
                .sinkage_exponent = 1.05,
                .cohesive_modulus = 0.0,
                .frictional_modulus = 1.4e6,
                .shear_modulus_m = 0.015};
  model.wheel = Wheel{.radius_m = 0.1, .width_m = 0.1};
  model.effects = {
      {.name = "slip_sinkage_ding", .covariate = "slip", .channel = Channel::Sinkage, .parameters = {0.5}},
      {.name = "bulldozing", .covariate = "sinkage_m", .channel = Channel::DrawbarPull, .parameters = {2.0}}};
  return model;
}

/// Forty rows predicted by the model, each reading with a normal error of 2 %.
Trial drive(const RefinedModel& model) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> error(1.0, 0.02);
  MadeRows rows(wheelColumns());
  for (int k = 0; k < 40; ++k) {
    WheelState s{.wheel = *model.wheel, .load_N = 50.0 + 2.0 * k, .slip = 0.05 + 0.02 * ((k * 7) % 40)};
    const Reading r = predict(model, s);
    rows.add({s.load_N, s.slip, r.torque_Nm * error(random), r.sinkage_m * error(random),
              r.drawbar_pull_N + 0.02 * s.load_N * (error(random) - 1.0) / 0.02, 0.1, 0.1});
  }
  return makeTrial(rows.telemetry(), model);
}

/// The model as stored in a file after tracing on another ground.
RefinedModel elsewhere(RefinedModel model) {
  model.soil = {.name = "other",
                .cohesion_Pa = 200.0,
                .friction_angle_rad = 0.65,
                .sinkage_exponent = 0.8,
                .cohesive_modulus = 0.0,
                .frictional_modulus = 4e5,
                .shear_modulus_m = 0.025};
  return model;
}

TEST(ModelSoil, SoilIsRecoveredOnlyWithTheActiveEffects) {
  const RefinedModel truth = digging();
  const Trial trial = drive(truth);
  const ModelSoil with = soilUnder(elsewhere(truth), trial, {.noise = 0.02});
  // Property: the soil of the rows is found within three standard deviations.
  EXPECT_NEAR(with.soil.cohesion_Pa, 900.0, 3.0 * std::sqrt(with.strength_covariance(0, 0)));
  EXPECT_NEAR(std::tan(with.soil.friction_angle_rad), std::tan(0.52),
              3.0 * std::sqrt(with.strength_covariance(1, 1)));
  EXPECT_LT(std::sqrt(with.strength_covariance(1, 1)), 0.05);
  EXPECT_LT(with.misfit, 2.0);
  RefinedModel bare = elsewhere(truth);
  bare.effects.clear();
  const ModelSoil without = soilUnder(bare, trial, {.noise = 0.02});
  // Property: a soil without the effects does not explain the rows.
  EXPECT_GT(without.misfit, 3.0 * with.misfit);
}

TEST(ModelSoil, StatedShearModulusIsKept) {
  const ModelSoil found = soilUnder(digging(), drive(digging()), {.shear_modulus_m = 0.02, .noise = 0.02});
  EXPECT_EQ(found.soil.shear_modulus_m, 0.02);
}

TEST(ModelSoil, ParameterAtItsRangeLimitIsReported) {
  RefinedModel truth = digging();
  truth.effects.clear();
  EXPECT_THAT(soilUnder(truth, drive(truth), {.noise = 0.02}).unseen,
              testing::Not(testing::Contains(testing::HasSubstr("limit of its range"))));
  truth.soil.sinkage_exponent = 4.5;
  truth.soil.frictional_modulus = 2e11;
  const ModelSoil found = soilUnder(elsewhere(truth), drive(truth), {.noise = 0.02});
  EXPECT_THAT(found.unseen, testing::Contains("sinkage_exponent: ended at the limit of its range"));
}

TEST(ModelSoil, ParametersFixedByThePriorAreKept) {
  RefinedModel prior = digging();
  prior.soil.cohesion_Pa = 500.0;
  prior.soil_prior_mean = {{"friction_angle_rad", 0.5}};
  prior.soil_prior_std = {{"friction_angle_rad", 0.1}};
  const ModelSoil found = soilUnder(digging(), drive(digging()), {.prior = prior, .noise = 0.02});
  EXPECT_EQ(found.soil.cohesion_Pa, 500.0);
  EXPECT_EQ(found.strength_covariance(0, 0), 0.0);
  EXPECT_GT(found.strength_covariance(1, 1), 0.0);
}

}  // namespace model_soil_test
}  // namespace talus::terramech
