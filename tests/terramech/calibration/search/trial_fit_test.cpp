#include <cmath>

#include <talus/terramech/calibration/search/trial_fit.hpp>

#include "calibration/noisy_rows.hpp"

namespace talus::terramech {
namespace trial_fit_test {

bool always(double) {
  return true;
}

TEST(TrialFit, SharedRunErrorIsSeparatedFromRowNoise) {
  const TrialFit together(sand(), noisyTrial(sand(), 0.02, 0.1), false, always);
  const Whitening& whitening = together.rows().whitening();
  ASSERT_EQ(whitening.common.unit.size(), 160U);
  // Property: ten offsets of 0.1 know their own variance to 45 %.
  EXPECT_NEAR(std::sqrt(whitening.common.run(0, 0)), 0.1, 0.05);
  // Property: the offsets' 0.1 of the load is not taken for the sensor's 2 % of a pull of some 0.3 W.
  const SensorNoise& noise = together.model().noise;
  EXPECT_LT(std::hypot(noise.absolute[0] / 80.0, 0.3 * noise.relative[0]), 0.03);
  const TrialFit alone(sand(), noisyTrial(sand(), 0.02), false, always);
  EXPECT_LT(std::sqrt(alone.rows().whitening().common.run(0, 0)), 0.01);
}

TEST(TrialFit, GivenSoilIsKeptAndUnknownSoilIsFitted) {
  RefinedModel start = sand();
  start.soil.friction_angle_rad = 0.4;
  const TrialFit given(start, noisyTrial(sand(), 0.02), false, always);
  EXPECT_EQ(given.model().soil.friction_angle_rad, 0.4);
  const TrialFit fitted(start, noisyTrial(sand(), 0.02), true, always);
  // Property: the friction angle that made the rows; 480 readings of 2 % know it better than the 0.15 rad it was off by.
  EXPECT_NEAR(fitted.model().soil.friction_angle_rad, 0.55, 0.05);
}

// Property: the model that made the rows scores above one of another soil, under the noise of either.
TEST(TrialFit, GeneratingModelScoresHigherThanAnotherSoil) {
  const TrialFit fit(sand(), noisyTrial(sand(), 0.02), false, always);
  RefinedModel softer = fit.model();
  softer.soil.frictional_modulus *= 0.5;
  EXPECT_GT(fit.scoreOf(fit.model()), fit.scoreOf(softer) + 10.0);
}

TEST(TrialFit, StrongestChannelIsThatOfTheFaultySensor) {
  RefinedModel model = sand();
  model.effects.push_back(
      {.name = "torque_offset", .covariate = "load_N", .channel = Channel::Torque, .parameters = {0.5}});
  const TrialFit fit(model, noisyTrial(sand(), 0.02), false, always);
  EXPECT_EQ(fit.strongest(0), Channel::Torque);
}

// Property: what is known of an effect that was found says nothing of the base's own. A pull that is off by 4 N shares its
// errors with the torque: tolerances of a quarter of it.
TEST(TrialFit, TrustIsInTheFirstEffectBehindTheBases) {
  const Effect offset{
      .name = "torque_offset", .covariate = "load_N", .channel = Channel::Torque, .parameters = {0.0}};
  const Effect zero{
      .name = "drawbar_zero", .covariate = "load_N", .channel = Channel::DrawbarPull, .parameters = {0.0}};
  RefinedModel base = sand();
  base.effects = {offset};
  TrialFit fit(base, noisyTrial(sand(), 0.02), false, always);
  fit.trust(Estimate{4.0, 1e-3});
  RefinedModel found = base;
  found.effects.push_back(zero);
  const RefinedModel fitted = fit.fitted(found, 10);
  EXPECT_NEAR(fitted.effects[0].parameters[0], 0.0, 1.0);
  EXPECT_NEAR(fitted.effects[1].parameters[0], 4.0, 1.0);
}

}  // namespace trial_fit_test
}  // namespace talus::terramech
