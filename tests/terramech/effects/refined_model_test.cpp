#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "effects_fixture.hpp"
#include "made_rows.hpp"

namespace talus::terramech {

namespace refined_model_test {

constexpr std::array kAll{Channel::DrawbarPull, Channel::Sinkage, Channel::Torque, Channel::SideForce};

// Closed form: pull DP/W, sinkage z/r, torque T/(r W), side force F/W.
TEST(ChannelReading, ChannelsAreScaledByLoadAndRadius) {
  const Reading reading{.load_N = 50.0,
                        .radius_m = 0.2,
                        .sinkage_m = 0.03,
                        .torque_Nm = 4.0,
                        .drawbar_pull_N = 10.0,
                        .side_force_N = -5.0};
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::DrawbarPull), 0.2);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::Sinkage), 0.15);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::Torque), 0.4);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::SideForce), -0.1);
}

// Property: a value added to one ratio changes that ratio and no other.
TEST(ChannelReading, AddScaledChangesOneChannelOnly) {
  for (const Channel channel : kAll) {
    const Reading before{.load_N = 50.0,
                         .radius_m = 0.2,
                         .sinkage_m = 0.03,
                         .torque_Nm = 4.0,
                         .drawbar_pull_N = 10.0,
                         .side_force_N = -5.0};
    Reading after = before;
    after.addScaled(channel, 0.07);
    for (const Channel other : kAll)
      EXPECT_NEAR(after.scaled(other) - before.scaled(other), other == channel ? 0.07 : 0.0, 1e-12);
  }
}

TEST(ChannelReading, ChannelNamesAreUnique) {
  std::set<std::string> names;
  for (const Channel channel : kAll) names.insert(name(channel));
  EXPECT_EQ(names.size(), kAll.size());
}

WheelContact loaded(double load_N, double slip) {
  WheelContact contact = contactOf(madeSand(), Wheel{});
  contact.load_N = load_N;
  contact.slip = slip;
  return contact;
}

TEST(WheelContact, WithoutEffectsMatchesWongReece) {
  // Property: two integrators of one model, with 8 and 24 points, differ by their quadrature error only.
  for (const double load : {15.0, 80.0, 250.0})
    for (const double slip : {-0.9, -0.3, 0.0, 0.1, 0.4, 0.9}) {
      const auto exact = equilibrium(madeSand(), Wheel{}, {.load_N = load, .slip = slip});
      const auto fast = solveContact(loaded(load, slip));
      constexpr double tolerance = 1e-6;
      EXPECT_NEAR(fast.sinkage_m, exact.sinkage_m, tolerance * exact.sinkage_m) << load << ' ' << slip;
      EXPECT_NEAR(fast.drawbar_pull_N, exact.drawbar_pull_N, tolerance * load) << load << ' ' << slip;
      EXPECT_NEAR(fast.torque_Nm, exact.torque_Nm, tolerance * load * 0.1) << load << ' ' << slip;
    }
}

TEST(WheelContact, BatchSolutionMatchesSingleSolutions) {
  // Property: a batch of wheels for the kernel, the fast rule, or both agrees with the same wheels solved
  // one at a time.
  std::vector<WheelContact> contacts;
  for (const double slip : {-0.5, 0.0, 0.05, 0.3, 0.6, 0.95}) {
    contacts.push_back(loaded(60.0, slip));
    contacts.push_back(loaded(60.0, slip));
    contacts.back().rebound = 0.1;
    contacts.push_back(loaded(1e7, slip));
  }
  SolvedContacts solved;
  solveContacts(contacts, solved);
  const std::vector<ContactForces>& forces = solved.forces;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const ContactForces one = solveContact(contacts[k]);
    EXPECT_NEAR(forces[k].sinkage_m, one.sinkage_m, 2e-7) << k;
    EXPECT_NEAR(forces[k].drawbar_pull_N, one.drawbar_pull_N, 1e-6 * contacts[k].load_N) << k;
    EXPECT_NEAR(forces[k].torque_Nm, one.torque_Nm, 1e-6 * contacts[k].load_N * contacts[k].radius_m) << k;
  }
}

TEST(WheelContact, UnchangedContactsAreNotSolvedAgain) {
  // Property: stored forces of an unchanged contact are returned; a changed contact is solved again.
  SolvedContacts solved;
  solveContacts({loaded(60.0, 0.3), loaded(80.0, 0.3)}, solved);
  solved.forces[0].torque_Nm = solved.forces[1].torque_Nm = -1.0;
  solveContacts({loaded(60.0, 0.3), loaded(80.0, 0.31)}, solved);
  EXPECT_EQ(solved.forces[0].torque_Nm, -1.0);
  EXPECT_NEAR(solved.forces[1].torque_Nm, solveContact(loaded(80.0, 0.31)).torque_Nm, 1e-6 * 80.0 * 0.1);
  solveContacts({loaded(60.0, 0.3)}, solved);
  EXPECT_GT(solved.forces[0].torque_Nm, 0.0);
}

TEST(WheelContact, ImposedSinkageIsReachedAtTheGivenLoad) {
  // Closed form: z = gain z0 + extra.
  WheelContact contact = loaded(80.0, 0.4);
  const double z0 = solveContact(contact).sinkage_m;
  contact.sinkage_gain = 2.0;
  contact.extra_sinkage_m = 0.003;
  const auto deep = solveContact(contact);
  EXPECT_NEAR(deep.sinkage_m, 2.0 * z0 + 0.003, 1e-12);
  // Property: more sinkage under the same load reduces the drawbar pull.
  EXPECT_LT(deep.drawbar_pull_N, solveContact(loaded(80.0, 0.4)).drawbar_pull_N);
}

TEST(WheelContact, SideForceIsOddAndPullEvenInTheSlipAngle) {
  WheelContact left = loaded(80.0, 0.3), right = left;
  left.slip_angle_rad = 0.3;
  right.slip_angle_rad = -0.3;
  const auto a = solveContact(left), b = solveContact(right);
  EXPECT_DOUBLE_EQ(a.drawbar_pull_N, b.drawbar_pull_N);
  EXPECT_DOUBLE_EQ(a.side_force_N, -b.side_force_N);
  EXPECT_LT(a.side_force_N, 0.0);
  EXPECT_LT(a.drawbar_pull_N, solveContact(loaded(80.0, 0.3)).drawbar_pull_N);
}

TEST(WheelContact, HardLayerLimitsSinkage) {
  WheelContact contact = loaded(200.0, 0.2);
  const double soft = solveContact(contact).sinkage_m;
  contact.hard_depth_m = 0.5 * soft;
  contact.hard_modulus_Pa_m = 1e9;
  // Property: the sinkage is between the layer's depth and the sinkage without the layer.
  EXPECT_GT(solveContact(contact).sinkage_m, 0.5 * soft);
  EXPECT_LT(solveContact(contact).sinkage_m, 0.75 * soft);
}

TEST(WheelContact, ExcessiveLoadSinksTheWheelToItsAxle) {
  WheelContact contact = loaded(1e7, 0.2);
  EXPECT_NEAR(solveContact(contact).sinkage_m, contact.radius_m, 1e-9);
}

TEST(WheelContact, LongitudinalAndLateralDiggingCombineByPath) {
  WheelContact c = contactOf(madeSand(), Wheel{.radius_m = 0.12, .grouser_height_m = 0.01});
  c.load_N = 80.0;
  c.slip = 0.4;
  const double z0 = solveContact(c).sinkage_m;
  c.dug_m = 0.003;
  c.ploughed_m = 0.004;
  c.extra_sinkage_m = 0.001;
  const ContactForces forces = solveContact(c);
  EXPECT_NEAR(forces.sinkage_m, z0 + 0.005 + 0.001, 1e-12);  // Closed form: hypot(3, 4) = 5.
  EXPECT_NEAR(forces.dug_m, 0.005 * 9.0 / 25.0, 1e-12);      // Closed form: share 3^2 / 5^2.
}

TEST(WheelState, CovariatesAreFoundByTheirTelemetryColumnName) {
  const WheelState s{.wheel = {.radius_m = 0.1, .width_m = 0.2, .grouser_height_m = 0.3, .grouser_count = 4},
                     .load_N = 5.0,
                     .slip = 0.6,
                     .slip_angle_rad = 0.7,
                     .speed_mps = 8.0,
                     .rim_speed_mps = 9.0,
                     .time_s = 10.0,
                     .pass_index = 11.0,
                     .slope_rad = 12.0};
  const std::vector<std::pair<const char*, double>> expected{
      {"wheel_radius_m", 0.1}, {"wheel_width_m", 0.2}, {"grouser_height_m", 0.3}, {"grouser_count", 4.0},
      {"load_N", 5.0},         {"slip", 0.6},          {"slip_angle_rad", 0.7},   {"speed_mps", 8.0},
      {"rim_speed_mps", 9.0},  {"time_s", 10.0},       {"pass_index", 11.0},      {"slope_rad", 12.0}};
  EXPECT_EQ(stateColumns().size(), expected.size());
  for (const auto& [name, value] : expected) {
    EXPECT_EQ(s.covariate(name), value) << name;
    EXPECT_EQ(std::count(stateColumns().begin(), stateColumns().end(), name), 1) << name;
  }
}

TEST(WheelState, ExtraColumnsAndGroupsAreCovariatesAndUnknownOnesNan) {
  WheelState s;
  s.extra = {{"moisture", 3.5}};
  s.group = {{"source", "a"}};
  EXPECT_EQ(s.covariate("moisture"), 3.5);
  EXPECT_EQ(s.covariate("source"), 1.0);
  EXPECT_EQ(s.covariate("constant"), 1.0);
  EXPECT_EQ(s.label("source"), "a");
  EXPECT_EQ(s.label("moisture"), "");
  EXPECT_TRUE(std::isnan(s.covariate("no_such_column")));
  EXPECT_TRUE(std::isnan(s.covariate("speed_mps")));  // NaN until it is set
}

TEST(WheelState, ProductOfTwoColumnsIsACovariate) {
  WheelState s{.load_N = 40.0};
  s.extra = {{"moisture", 3.5}, {"a*b", 7.0}};
  EXPECT_EQ(s.covariate("moisture*load_N"), 140.0);
  EXPECT_EQ(s.covariate("a*b"), 7.0);  // a column of that name takes precedence
  EXPECT_TRUE(std::isnan(s.covariate("moisture*no_such_column")));
}

TEST(WheelState, SetCovariateRoundTrips) {
  // Property: setCovariate() accepts every column and no other.
  WheelState s;
  s.extra = {{"moisture", 3.5}};
  double value = 1.0;
  for (const std::string& column : stateColumns()) s.setCovariate(column, value += 1.0);
  value = 1.0;
  for (const std::string& column : stateColumns()) EXPECT_EQ(s.covariate(column), value += 1.0) << column;
  s.setCovariate("moisture", 4.5);
  s.setCovariate("no_such_column", 1.0);
  EXPECT_EQ(s.covariate("moisture"), 4.5);
  EXPECT_TRUE(std::isnan(s.covariate("no_such_column")));
}

TEST(Effects, NamesAreUniqueAndEveryFormIsDocumented) {
  std::set<std::string> seen;
  for (const EffectForm& form : effectLibrary()) {
    EXPECT_TRUE(seen.insert(form.name).second) << form.name;
    EXPECT_TRUE(form.act || form.read) << form.name;
    EXPECT_STRNE(form.formula, "") << form.name;
    EXPECT_STRNE(form.source, "") << form.name;
    for (const EffectParameter& p : form.parameters) {
      EXPECT_LE(p.low, p.typical) << form.name << ' ' << p.name;
      EXPECT_GE(p.high, p.typical) << form.name << ' ' << p.name;
    }
  }
}

TEST(Effects, EveryFormHasAFiniteEffectAtItsTypicalSize) {
  // Property: every form changes the prediction, by a finite amount below ten loads.
  for (const EffectForm& form : effectLibrary()) {
    RefinedModel model = base();
    model.effects = {typical(form)};
    const WheelState at = state(std::string(form.name) == "skid_sinkage" ? -0.5 : 0.5);
    const double moved = change(predict(model, at), predict(base(), at));
    if (std::string(form.name) == "layered_hardpan") continue;  // acts only if the sinkage reaches the layer
    if (std::string(form.name) == "rear_fill") continue;        // acts only on soil dug by other forms
    EXPECT_GT(moved, 1e-6) << form.name;
    EXPECT_LT(moved, 10.0) << form.name;
  }
}

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
