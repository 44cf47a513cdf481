#include <cmath>
#include <set>
#include <string>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/effects/effects.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace {

RefinedModel base() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

WheelState state(double slip = 0.5) {
  WheelState s;
  s.wheel.radius_m = 0.12;
  s.wheel.grouser_height_m = 0.01;
  s.load_N = 80.0;
  s.slip = slip;
  s.slip_angle_rad = 0.2;
  s.speed_mps = 0.1;
  s.rim_speed_mps = 0.2;
  s.time_s = 0.3;
  s.pass_index = 3.0;
  s.slope_rad = 0.15;
  return s;
}

Effect typical(const EffectForm& form) {
  Effect effect{.name = form.name, .covariate = form.covariate, .channel = form.channel};
  for (const EffectParameter& p : form.parameters) effect.parameters.push_back(p.typical);
  return effect;
}

double change(const Reading& a, const Reading& b) {
  double most = 0.0;
  for (int c = 0; c < kChannels; ++c)
    most = std::max(most, std::abs(a.scaled(static_cast<Channel>(c)) - b.scaled(static_cast<Channel>(c))));
  return most;
}

TEST(Effects, NamesAreUniqueAndEveryFormSaysWhatItIs) {
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

TEST(Effects, EveryFormActsAtItsTypicalSize) {
  // Property: none is dead; the change stays finite and below ten loads.
  for (const EffectForm& form : effectLibrary()) {
    RefinedModel model = base();
    model.effects = {typical(form)};
    const WheelState at = state(std::string(form.name) == "skid_sinkage" ? -0.5 : 0.5);
    const double moved = change(predict(model, at), predict(base(), at));
    if (std::string(form.name) == "layered_hardpan") continue;  // its depth is beyond this sinkage or not
    if (std::string(form.name) == "rear_fill") continue;        // of what other forms dig
    EXPECT_GT(moved, 1e-6) << form.name;
    EXPECT_LT(moved, 10.0) << form.name;
  }
}

TEST(Effects, AnUnknownCovariateLeavesTheModelNeutral) {
  for (const EffectForm& form : effectLibrary()) {
    RefinedModel model = base();
    model.effects = {typical(form)};
    model.effects[0].covariate = "no_such_column";
    EXPECT_EQ(change(predict(model, state()), predict(base(), state())), 0.0) << form.name;
  }
}

TEST(Effects, AnEffectOfOneGroupLeavesTheOthersAlone) {
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

TEST(Effects, LyaskoSinkageFollowsItsLaw) {
  // Closed form: (1 + i)/(1 - 0.5 i) = 2 at i = 0.5.
  RefinedModel model = base();
  const double z0 = predict(model, state()).sinkage_m;
  model.effects = {typical(*findEffect("slip_sinkage_lyasko"))};
  EXPECT_NEAR(predict(model, state()).sinkage_m, 2.0 * z0, 1e-9);
}

TEST(Effects, ADraggedWheelSinksByTheSquareOfWhatItDoesNotRoll) {
  // Closed form: 0.3 r (1 - r omega/v)^2 with r omega/v = 1 + slip; none where the wheel drives.
  RefinedModel model = base();
  model.effects = {typical(*findEffect("skid_sinkage"))};
  for (const double slip : {-1.0, -0.6, -0.2, 0.3}) {
    WheelState s = state(slip);
    s.slip_angle_rad = 0.0;
    const double extra = slip < 0.0 ? 0.3 * 0.12 * slip * slip : 0.0;
    EXPECT_NEAR(predict(model, s).sinkage_m, predict(base(), s).sinkage_m + extra, 1e-9) << slip;
  }
}

TEST(Effects, SideForceAgainstTheTravelAndNoPloughingStraightOn) {
  RefinedModel model = base();
  model.effects = {typical(*findEffect("side_ploughing"))};
  WheelState s = state(0.2);
  s.slip_angle_rad = 0.0;
  EXPECT_NEAR(change(predict(model, s), predict(base(), s)), 0.0, 1e-12);
  double last = 0.0;
  for (const double angle : {0.3, 0.8, 1.3}) {
    s.slip_angle_rad = angle;
    const Reading right = predict(model, s);
    s.slip_angle_rad = -angle;
    const Reading left = predict(model, s);
    // Property: the side force is odd, the rest even, and sinkage grows with the angle (at small ones the
    // contact behind carries a little more).
    EXPECT_LT(right.side_force_N, 0.0);
    EXPECT_NEAR(right.side_force_N, -left.side_force_N, 1e-9);
    EXPECT_NEAR(right.drawbar_pull_N, left.drawbar_pull_N, 1e-9);
    EXPECT_GT(right.sinkage_m, last);
    last = right.sinkage_m;
  }
}

Effect with(const char* name, std::vector<double> parameters) {
  Effect effect = typical(*findEffect(name));
  effect.parameters = std::move(parameters);
  return effect;
}

WheelState straightOn(double slip) {
  WheelState s = state(slip);
  s.slip_angle_rad = 0.0;
  return s;
}

TEST(Effects, ADrivenWheelDigsByItsSlipAndALuggedOneByReecesLaw) {
  for (const double slip : {-0.6, 0.0, 0.4, 0.8}) {
    const double z0 = predict(base(), straightOn(slip)).sinkage_m, i = std::max(0.0, slip);
    RefinedModel model = base();
    model.effects = {with("slip_sinkage_linear", {0.5})};
    // Closed form: z0 (1 + a i), and z0 + a h i / (1 - i) with h = 10 mm; a braked wheel does not dig so.
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i), 1e-9) << slip;
    model.effects = {with("slip_sinkage_reece", {0.4})};
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 + 0.4 * 0.01 * i / (1.0 - i), 1e-9) << slip;
    model.effects.push_back(with("slip_sinkage_linear", {0.5}));
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i) + 0.4 * 0.01 * i / (1.0 - i),
                1e-9);
  }
}

TEST(Effects, WhatIsDugAlongAndPloughedAcrossAddAsPaths) {
  WheelContact c = contactOf(base().soil, state().wheel);
  c.load_N = 80.0;
  c.slip = 0.4;
  const double z0 = solveContact(c).sinkage_m;
  c.dug_m = 0.003;
  c.ploughed_m = 0.004;
  c.extra_sinkage_m = 0.001;
  const ContactForces forces = solveContact(c);
  EXPECT_NEAR(forces.sinkage_m, z0 + 0.005 + 0.001, 1e-12);  // Closed form: hypot(3, 4) = 5.
  EXPECT_NEAR(forces.dug_m, 0.005 * 9.0 / 25.0, 1e-12);      // Closed form: its share of the square.
}

TEST(Effects, SoilBehindADiggingWheelPushesItAndItDoesNotBulldozeWhatItDug) {
  RefinedModel model = base();
  model.effects = {with("slip_sinkage_linear", {1.0})};
  const Reading digs = predict(model, straightOn(0.6));
  model.effects.push_back(with("rear_fill", {1.0}));
  const Reading filled = predict(model, straightOn(0.6));
  // Property: contact behind the axle bears the wheel and pushes it forward, at the same depth.
  EXPECT_GT(filled.drawbar_pull_N, digs.drawbar_pull_N);
  EXPECT_EQ(filled.sinkage_m, digs.sinkage_m);
  EXPECT_NEAR(filled.dug_m, 0.6 / 1.6 * filled.sinkage_m, 1e-12);  // Closed form: z0 (1 + a i).
  model.effects.push_back(with("bulldozing_ahead", {2.0}));
  const double pushed = filled.sinkage_m - filled.dug_m, kp = std::pow(std::tan(0.25 * M_PI + 0.275), 2);
  // Closed form: a b gamma z_p^2 Kp / 2, gamma = 1600 kg/m^3 x 9.80665 m/s^2.
  EXPECT_NEAR(filled.drawbar_pull_N - predict(model, straightOn(0.6)).drawbar_pull_N,
              2.0 * state().wheel.width_m * 0.5 * 1600.0 * 9.80665 * pushed * pushed * kp, 1e-6);
}

TEST(Effects, ARoughFaceBrakesALockedWheelPushesASpinningOneAndBearsLessBesideIt) {
  RefinedModel model = base();
  model.slip_along_travel = true;
  model.effects = {with("side_ploughing", {0.5, 1.0}), with("side_bulldozing_rough", {1.0, 0.0})};
  RefinedModel rough = model;
  rough.effects[1].parameters[1] = 0.4;
  const auto added = [&](double slip, Channel channel) {
    WheelState s = state(slip);
    s.slip_angle_rad = 1.2;
    return predict(rough, s).scaled(channel) - predict(model, s).scaled(channel);
  };
  // Property: friction acts against the way that the face slides over the soil.
  EXPECT_LT(added(-1.0, Channel::DrawbarPull), -0.01);
  EXPECT_GT(added(0.8, Channel::DrawbarPull), 0.01);
  // Property: what friction does along is lost to what it holds down (side force < 0 against the motion).
  EXPECT_LT(added(-0.7, Channel::SideForce), added(0.8, Channel::SideForce));
  EXPECT_LT(added(0.8, Channel::SideForce), 0.0);
}

TEST(Effects, OfTheSideStandInPlaceOfTheBases) {
  RefinedModel model = base();
  const Reading plain = predict(model, state());
  RefinedModel bare = model;
  bare.soil.digging_exponent = bare.soil.side_bulldozing = 0.0;
  // Property: a form that adds nothing takes the base's term of its kind out, and no other.
  model.effects = {with("side_bulldozing", {0.0}), with("side_slip_sinkage", {0.0})};
  const Reading none = predict(model, state()), want = predict(bare, state());
  EXPECT_EQ(none.side_force_N, want.side_force_N);
  EXPECT_EQ(none.sinkage_m, want.sinkage_m);
  model.effects = {with("side_bulldozing", {0.0})};
  EXPECT_EQ(predict(model, state()).sinkage_m, plain.sinkage_m);
  EXPECT_GT(std::abs(plain.side_force_N), std::abs(predict(model, state()).side_force_N));
}

TEST(Effects, TheBaseAtASlipAngleIsTheWheelOfTheLiterature) {
  for (const double slip : {-1.0, -0.4, 0.0, 0.3, 0.9}) {
    const WheelState s = state(slip);
    const Reading r = predict(base(), s);
    const WheelForces f = equilibrium(base().soil, s.wheel,
                                      {.load_N = s.load_N, .slip = slip, .slip_angle_rad = s.slip_angle_rad});
    // Property: two solvers of one wheel; 1e-4 for the quicker rule of a dragged one.
    EXPECT_NEAR(r.side_force_N / s.load_N, f.side_force_N / s.load_N, 1e-4) << slip;
    EXPECT_NEAR(r.drawbar_pull_N / s.load_N, f.drawbar_pull_N / s.load_N, 1e-4) << slip;
    EXPECT_NEAR(r.sinkage_m / f.sinkage_m, 1.0, 1e-4) << slip;
  }
}

TEST(Effects, SideForceIsSteadyThroughNinetyDegrees) {
  RefinedModel model = base();
  model.slip_along_travel = true;
  model.effects = {with("side_slip_lateral_shear", {1.0})};
  for (const double slip : {-0.5, 0.0, 0.5}) {
    WheelState s = state(slip);
    s.slip_angle_rad = 1.55;
    const double before = predict(model, s).scaled(Channel::SideForce);
    s.slip_angle_rad = 0.5 * M_PI + 0.003;  // as a test bed reads its 90 deg
    const double at = predict(model, s).scaled(Channel::SideForce);
    // Property: the travel across shears the soil where there is none along.
    EXPECT_LT(at, -0.1) << slip;
    EXPECT_NEAR(at, before, 0.05 * std::abs(before)) << slip;
  }
}

TEST(Effects, SplineIsNaturalAndConstantOutside) {
  const std::vector<double> x{0.0, 1.0, 2.0}, y{0.0, 1.0, 0.0};
  // Closed form: natural cubic through (0,0), (1,1), (2,0) is 1.5 t - 0.5 t^3 on the first piece.
  const NaturalSpline spline{x, y};
  EXPECT_NEAR(spline(0.5), 1.5 * 0.5 - 0.5 * 0.125, 1e-12);
  EXPECT_EQ(spline(-3.0), 0.0);
  EXPECT_EQ(spline(9.0), 0.0);
}

TEST(RefinedModel, TheLinearFormulaStartsFromWhatWasMeasured) {
  RefinedModel model = base();
  model.base = BaseModel::LinearFormula;
  WheelState s = state();
  const Reading solved = predict(model, s);
  // Closed form: T/(rW) - z/r - 0.1.
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

TEST(RefinedModel, StdHoldsTheSensorsAndTheSlip) {
  RefinedModel model = base();
  model.noise.absolute[0] = 0.02 * 80.0;
  EXPECT_NEAR(predictWithStd(model, state()).scaled_std[0], 0.02, 1e-12);
  model.noise.slip_absolute = 0.02;
  EXPECT_GT(predictWithStd(model, state(0.05)).scaled_std[0], 0.02);
}

}  // namespace
}  // namespace talus::terramech
