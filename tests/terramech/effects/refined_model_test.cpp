#include <cmath>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace refined_model_test {

TEST(RefinedModel, UnknownCovariateLeavesPredictionsUnchanged) {
  for (const EffectForm& form : effectLibrary()) {
    RefinedModel model = base();
    model.effects = {typical(form)};
    model.effects[0].covariate = "no_such_column";
    EXPECT_EQ(change(predict(model, state()), predict(base(), state())), 0.0) << form.name;
  }
}

TEST(RefinedModel, LinearFormulaUsesMeasuredTorqueAndSinkage) {
  RefinedModel model = base();
  model.base = BaseModel::LinearFormula;
  WheelState s = state();
  const Reading solved = predict(model, s);
  // Closed form: DP/W = T/(rW) - z/r - 0.1 (drawbar pull from torque and sinkage).
  EXPECT_NEAR(solved.scaled(Channel::DrawbarPull),
              solved.scaled(Channel::Torque) - solved.scaled(Channel::Sinkage) - 0.1, 1e-12);
  s.measured_torque_Nm = 0.4 * 80.0 * 0.12;
  s.measured_sinkage_m = 0.06 * 0.12;
  EXPECT_NEAR(predict(model, s).scaled(Channel::DrawbarPull), 0.4 - 0.06 - 0.1, 1e-12);
  EXPECT_EQ(predict(model, s).torque_Nm, solved.torque_Nm);
}

TEST(RefinedModel, SlipInTheWheelPlaneGrowsWithTheSlipAngle) {
  // Closed form: 1 - 0.8 cos 60 deg = 0.6; a wheel braked along the travel may be driven in its own plane.
  EXPECT_NEAR(slipInWheelPlane(0.2, std::acos(0.5)), 0.6, 1e-12);
  EXPECT_NEAR(slipInWheelPlane(-0.5, std::acos(0.5)), 0.0, 1e-12);
}

TEST(RefinedModel, SideForceIsOddAndOtherChannelsEvenInSlipAngle) {
  // Property: forces and curves are symmetric in left and right: the side force is odd in the slip angle,
  // all other channels are even.
  std::vector<Effect> effects;
  for (const EffectForm& form : effectLibrary())
    if (!form.of_sensor) effects.push_back(typical(form));
  for (const Channel channel : {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque, Channel::SideForce})
    effects.push_back({.name = "empirical",
                       .covariate = "sinkage_m",
                       .channel = channel,
                       .parameters = {0.1, 0.3},
                       .knots = {0.0, 0.05}});
  for (const Effect& effect : effects) {
    RefinedModel model = base();
    model.effects = {effect};
    WheelState left = state(), right = state();
    left.slip_angle_rad = 0.4;
    right.slip_angle_rad = -0.4;
    const Reading to_left = predict(model, left), to_right = predict(model, right);
    EXPECT_NE(to_left.side_force_N, 0.0);
    EXPECT_NEAR(to_left.side_force_N, -to_right.side_force_N, 1e-9) << effect.name;
    EXPECT_NEAR(to_left.drawbar_pull_N, to_right.drawbar_pull_N, 1e-9) << effect.name;
    EXPECT_NEAR(to_left.sinkage_m, to_right.sinkage_m, 1e-12) << effect.name;
    EXPECT_NEAR(to_left.torque_Nm, to_right.torque_Nm, 1e-9) << effect.name;
    EXPECT_EQ(predict(model, straightOn(0.5)).side_force_N, 0.0) << effect.name;
  }
}

TEST(RefinedModel, SlipStdIsLimitedNearALockedWheel) {
  // Closed form: |i| e, limited to the distance from i = -1, where r omega = 0.
  const SensorNoise noise{.slip_absolute = 0.03, .slip_relative = 0.04};
  EXPECT_DOUBLE_EQ(noise.slipStd(-1.0), 0.03);
  EXPECT_DOUBLE_EQ(noise.slipStd(-0.99), std::hypot(0.03, 0.01));
  EXPECT_DOUBLE_EQ(noise.slipStd(-0.5), std::hypot(0.03, 0.02));
  EXPECT_DOUBLE_EQ(noise.slipStd(0.0), 0.03);
  EXPECT_DOUBLE_EQ(noise.slipStd(1.0), 0.05);
  // Property: no slip error is propagated for a locked wheel dragged along its axle, which with a slip error
  // would turn and dig.
  RefinedModel model = base();
  WheelState locked = state();
  locked.slip = -1.0;
  locked.slip_angle_rad = 1.5707;
  const double sure = predictWithStd(model, locked).scaled_std[0];
  model.noise.slip_relative = 0.06;
  EXPECT_EQ(predictWithStd(model, locked).scaled_std[0], sure);
}

TEST(RefinedModel, StdIncludesSensorNoiseAndSlipError) {
  RefinedModel model = base();
  model.noise.absolute[0] = 0.02 * 80.0;
  EXPECT_NEAR(predictWithStd(model, state()).scaled_std[0], 0.02, 1e-12);
  model.noise.slip_absolute = 0.02;
  EXPECT_GT(predictWithStd(model, state(0.05)).scaled_std[0], 0.02);
}

TEST(RefinedModel, EffectOfOneGroupLeavesOtherGroupsUnchanged) {
  RefinedModel model = base();
  model.effects = {typical(*findEffect("load_cell_tilt"))};
  model.effects[0].only_column = "source";
  model.effects[0].only_value = "b";
  WheelState a = state(), b = state();
  a.group = {{"source", "a"}};
  b.group = {{"source", "b"}};
  EXPECT_EQ(change(predict(model, a), predict(base(), a)), 0.0);
  // Closed form: DP cos e + W sin e.
  const double dp = predict(base(), b).drawbar_pull_N;
  EXPECT_NEAR(predict(model, b).drawbar_pull_N, dp * std::cos(0.02) + 80.0 * std::sin(0.02), 1e-12);
}

TEST(RefinedModel, BatchPredictionMatchesSinglePredictions) {
  // Property: batch and single predictions agree to the kernel's accuracy, 1e-6 of the load, with and
  // without effects.
  RefinedModel refined = base();
  refined.effects = {typical(*findEffect("slip_sinkage_linear")), typical(*findEffect("bulldozing")),
                     typical(*findEffect("torque_offset"))};
  for (const RefinedModel& model : {base(), refined}) {
    std::vector<WheelState> states;
    for (int k = 0; k < 9; ++k) states.push_back(straightOn(0.1 * k));
    SolvedContacts solved;
    const std::vector<Reading> readings = predict(model, states, solved);
    for (std::size_t k = 0; k < states.size(); ++k)
      EXPECT_LT(change(readings[k], predict(model, states[k])), 2e-6) << k;
  }
}

TEST(RefinedModel, WithoutSensorsKeepsOnlyGroundEffects) {
  RefinedModel model = base();
  model.effects = {typical(*findEffect("torque_offset")), typical(*findEffect("bulldozing")),
                   typical(*findEffect("slip_bias"))};
  const RefinedModel ground = withoutSensors(model);
  ASSERT_EQ(ground.effects.size(), 1U);
  EXPECT_EQ(ground.effects[0].name, "bulldozing");
}

TEST(RefinedModel, CurvesScaleSoilParametersOrAddToAChannel) {
  // Closed form: one knot is a constant curve; e^{ln 2} k, and 0.1 W.
  RefinedModel model = base(), stiff = base();
  stiff.soil.cohesive_modulus *= 2.0;
  stiff.soil.frictional_modulus *= 2.0;
  model.effects = {
      {.name = "empirical_stiffness", .covariate = "slip", .parameters = {std::log(2.0)}, .knots = {0.3}}};
  EXPECT_LT(change(predict(model, state()), predict(stiff, state())), 1e-9);
  model.effects[0].name = "empirical";
  model.effects[0].parameters = {0.1};
  EXPECT_NEAR(predict(model, state()).drawbar_pull_N - predict(base(), state()).drawbar_pull_N, 8.0, 1e-9);
}

TEST(RefinedModel, FittedParametersRoundTripThroughSetValue) {
  RefinedModel model = base();
  model.effects = {with("bulldozing_two_term", {1.0, 2.0})};
  EXPECT_EQ(value(model, {.effect = 0, .index = 1}), 2.0);
  setValue(model, {.effect = 0, .index = 1}, 3.5);
  EXPECT_EQ(model.effects[0].parameters[1], 3.5);
  for (std::size_t k = 0; k < soilParameters().size(); ++k) {
    const SoilParameter& p = soilParameters()[k];
    if (std::string_view(p.name) == "log_stiffness") continue;  // a step, not a value
    const double middle = 0.5 * (p.low + p.high);
    setValue(model, {.effect = -1, .index = static_cast<int>(k)}, middle);
    EXPECT_DOUBLE_EQ(value(model, {.effect = -1, .index = static_cast<int>(k)}), middle) << p.name;
  }
}

TEST(RefinedModel, StdIncludesFittedParameters) {
  // Closed form: DP_m = DP + F0, so that the standard deviation of drawbar pull over load is that of F0 over
  // W; that of other channels is 0.
  RefinedModel model = base();
  model.effects = {with("drawbar_zero", {1.0})};
  model.fitted = {{.effect = 0, .index = 0}};
  model.covariance = {16.0};
  const Prediction p = predictWithStd(model, state());
  EXPECT_NEAR(p.scaled_std[0], 4.0 / 80.0, 1e-9);
  EXPECT_NEAR(p.scaled_std[1], 0.0, 1e-9);
  EXPECT_NEAR(p.scaled_std[2], 0.0, 1e-9);
}

TEST(RefinedModel, StdIncludesParameterCovariance) {
  // Closed form: of a sum of two offsets the variance is 4 + 9 + 2 (-2) = 9.
  RefinedModel model = base();
  model.effects = {with("drawbar_zero", {1.0}), with("drawbar_zero", {-2.0})};
  model.fitted = {{.effect = 0, .index = 0}, {.effect = 1, .index = 0}};
  model.covariance = {4.0, -2.0, -2.0, 9.0};
  EXPECT_NEAR(predictWithStd(model, state()).scaled_std[0], 3.0 / 80.0, 1e-9);
}

}  // namespace refined_model_test
}  // namespace talus::terramech
