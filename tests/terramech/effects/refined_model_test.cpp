#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "effects_fixture.hpp"
#include "made_rows.hpp"

namespace talus::terramech {
namespace refined_model_test {

TEST(EffectsContact, LyaskoSinkageMatchesClosedForm) {
  // Closed form: (1 + i)/(1 - 0.5 i) = 2 at i = 0.5.
  RefinedModel model = base();
  const double z0 = predict(model, state()).sinkage_m;
  model.effects = {typical(*findEffect("slip_sinkage_lyasko"))};
  EXPECT_NEAR(predict(model, state()).sinkage_m, 2.0 * z0, 1e-9);
}

TEST(EffectsContact, SideForceIsContinuousAtNinetyDegrees) {
  RefinedModel model = base();
  model.slip_along_travel = true;
  model.effects = {with("side_slip_lateral_shear", {1.0})};
  for (const double slip : {-0.5, 0.0, 0.5}) {
    WheelState s = state(slip);
    s.slip_angle_rad = 1.55;
    const double before = predict(model, s).scaled(Channel::SideForce);
    s.slip_angle_rad = 0.5 * std::numbers::pi + 0.003;  // 90 deg with a measurement error
    const double at = predict(model, s).scaled(Channel::SideForce);
    // Property: sideways travel shears the soil even if the longitudinal displacement is zero.
    EXPECT_LT(at, -0.1) << slip;
    EXPECT_NEAR(at, before, 0.05 * std::abs(before)) << slip;
  }
}

TEST(EffectsContact, RateEffectsAreAPowerOrLogarithmOfSpeed) {
  // Closed form: k (v/v0)^m with v = 4 v0, m = 1/2; tau (1 + a ln(v/v0)) with v = e v0.
  EXPECT_NEAR(acted("rate_pressure_grahn", {0.5, 0.05}, 0.2).sinkage_modulus, 2e6, 1e-6);
  const WheelContact shear = acted("rate_shear", {0.1, 0.05}, 0.05 * std::exp(1.0));
  EXPECT_NEAR(shear.cohesion_Pa, 1100.0, 1e-9);
  EXPECT_NEAR(shear.tan_friction, 0.55, 1e-12);
  // Closed form: the sliding speed of the rim is i r omega = 0.5 x 0.2 m/s = e v0; without a measured rim
  // speed i v / (1 - i).
  WheelState s{.slip = 0.5, .rim_speed_mps = 0.2};
  EXPECT_NEAR(acted("rate_shear_slip_velocity", {0.1, 0.1 / std::exp(1.0)}, 0.0, s).cohesion_Pa, 1100.0,
              1e-9);
  s.rim_speed_mps = WheelState::kUnknown;
  EXPECT_NEAR(acted("rate_shear_slip_velocity", {0.1, 0.1 / std::exp(1.0)}, 0.1, s).cohesion_Pa, 1100.0,
              1e-9);
  // Property: the strength remains positive at any speed.
  EXPECT_GT(acted("rate_shear", {0.5, 10.0}, 0.0).cohesion_Pa, 0.0);
}

TEST(EffectsContact, MultipassEffectsSaturate) {
  // Closed form: 1 - e^{-(p - first)/p0} = 1/2 at p = first + p0 ln 2, and 0 at the first pass.
  const double half = 1.0 + 3.0 * std::log(2.0);
  EXPECT_NEAR(acted("multipass_stiffness", {0.4, 3.0, 1.0}, half).sinkage_modulus, 1.2e6, 1e-6);
  EXPECT_EQ(acted("multipass_stiffness", {0.4, 3.0, 1.0}, 1.0), plainContact());
  const WheelContact strength = acted("multipass_strength", {2.0, 3.0, 1.0}, half);
  EXPECT_NEAR(strength.cohesion_Pa, 2000.0, 1e-9);
  EXPECT_NEAR(strength.shear_modulus_m, 0.01, 1e-12);
  const WheelContact compaction = acted("multipass_compaction", {0.4, 3.0, 1.0, 2.0}, half);
  EXPECT_NEAR(compaction.sinkage_modulus, 1.2e6, 1e-6);
  EXPECT_NEAR(compaction.cohesion_Pa, 2000.0, 1e-9);
  // Closed form: k x 4 and K / 2 from the second pass on.
  EXPECT_EQ(acted("multipass_reload", {3.0, 1.0}, 1.0), plainContact());
  const WheelContact reload = acted("multipass_reload", {3.0, 1.0}, 2.0);
  EXPECT_NEAR(reload.sinkage_modulus, 4e6, 1e-6);
  EXPECT_NEAR(reload.shear_modulus_m, 0.01, 1e-12);
}

TEST(EffectsContact, GrouserAndWheelSizeEffectsMatchClosedForm) {
  EXPECT_NEAR(acted("grouser_shear_radius", {0.7}, 0.01).shear_radius_m, 0.207, 1e-12);
  // Closed form: at h = b the factor is 1 + 0.64 atan(1).
  const WheelState square{.wheel = {.width_m = 0.1, .grouser_height_m = 0.1}};
  EXPECT_NEAR(acted("grouser_thrust", {1.0}, 0.1, square).tan_friction, 0.5 * (1.0 + 0.16 * std::numbers::pi),
              1e-12);
  EXPECT_EQ(acted("grouser_thrust", {1.0}, 0.0, {}), plainContact());
  // Closed form: 1 + W/S = 1.1; (D/D0)^m = 2.
  const WheelContact soft = acted("wheel_flexibility", {0.001}, 100.0);
  EXPECT_NEAR(soft.radius_m, 0.22, 1e-12);
  EXPECT_NEAR(soft.shear_radius_m, 0.22, 1e-12);
  EXPECT_NEAR(acted("wheel_diameter", {0.5, 0.1}, 0.2).sinkage_modulus, 2e6, 1e-6);
}

TEST(EffectsContact, SlopeReducesLoadAndSideSlipIncreasesSinkage) {
  // Closed form: N = W (cos a - (h/L) sin a), at 30 deg with h/L = 1; never below a twentieth of W.
  EXPECT_NEAR(acted("slope_load_transfer", {1.0}, std::numbers::pi / 6).load_N, 50.0 * (std::sqrt(3.0) - 1.0),
              1e-9);
  EXPECT_NEAR(acted("slope_load_transfer", {2.0}, 1.4).load_N, 5.0, 1e-12);
  EXPECT_NEAR(acted("side_slip_sinkage", {0.6}, -std::numbers::pi / 6).sinkage_exponent, 1.3, 1e-12);
  const WheelContact both = acted("side_slip", {2.0, 0.6}, -std::numbers::pi / 6);
  EXPECT_NEAR(both.sinkage_exponent, 1.3, 1e-12);
  EXPECT_NEAR(both.shear_modulus_m, 0.04, 1e-12);
}

TEST(EffectsContact, DingExponentGrowsWithAbsoluteSlip) {
  for (const double slip : {-0.5, 0.5}) {
    const WheelState s{.slip = slip};
    EXPECT_NEAR(acted("slip_sinkage_ding", {0.4}, slip, s).sinkage_exponent, 1.2, 1e-12);
    EXPECT_NEAR(acted("slip_sinkage_ding_quadratic", {0.4, -0.8}, slip, s).sinkage_exponent, 1.0, 1e-12);
  }
  // Property: the exponent stays above 0, where z0 is defined.
  EXPECT_EQ(acted("slip_sinkage_ding_quadratic", {-1.0, -3.0}, 1.0, {.slip = 1.0}).sinkage_exponent, 0.1);
}

// Property: the slip sinkage of the base and Ding's effect have the same formula; together they equal one
// effect with the sum of both parameters.
TEST(EffectsContact, BaseSlipSinkageEqualsTheDingEffect) {
  for (const double slip : {-0.4, 0.2, 0.7}) {
    RefinedModel effect = base(), soil = base(), both = base();
    effect.effects = {with("slip_sinkage_ding", {0.5})};
    soil.soil.slip_sinkage_exponent = 0.5;
    both.effects = {with("slip_sinkage_ding", {0.3})};
    both.soil.slip_sinkage_exponent = 0.2;
    const Reading a = predict(effect, state(slip)), b = predict(soil, state(slip)),
                  c = predict(both, state(slip));
    EXPECT_GT(a.sinkage_m, predict(base(), state(slip)).sinkage_m);
    EXPECT_NEAR(a.sinkage_m, b.sinkage_m, 1e-9);
    EXPECT_NEAR(a.drawbar_pull_N, b.drawbar_pull_N, 1e-5);
    EXPECT_NEAR(a.sinkage_m, c.sinkage_m, 1e-9);
  }
}

TEST(EffectsContact, ReboundAndHardpanSetTheirContactParameters) {
  EXPECT_EQ(acted("elastic_rebound", {0.3}, 0.01).rebound, 0.3);
  const WheelContact layered = acted("layered_hardpan", {0.01, 1e7}, 0.01);
  EXPECT_EQ(layered.hard_depth_m, 0.01);
  EXPECT_EQ(layered.hard_modulus_Pa_m, 1e7);
}

TEST(EffectsDigging, BrakedWheelSinkageIsQuadraticInSkid) {
  // Closed form: 0.3 r (1 - r omega/v)^2 with r omega/v = 1 + slip; 0 for a driven wheel.
  RefinedModel model = base();
  model.effects = {typical(*findEffect("skid_sinkage"))};
  for (const double slip : {-1.0, -0.6, -0.2, 0.3}) {
    WheelState s = state(slip);
    s.slip_angle_rad = 0.0;
    const double extra = slip < 0.0 ? 0.3 * 0.12 * slip * slip : 0.0;
    EXPECT_NEAR(predict(model, s).sinkage_m, predict(base(), s).sinkage_m + extra, 1e-9) << slip;
  }
}

TEST(EffectsDigging, PloughingIsOddInSlipAngleAndZeroStraightAhead) {
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
    // Property: the side force is odd in the slip angle, the other quantities are even. The sinkage grows
    // with the angle (at small angles the rear contact carries slightly more).
    EXPECT_LT(right.side_force_N, 0.0);
    EXPECT_NEAR(right.side_force_N, -left.side_force_N, 1e-9);
    EXPECT_NEAR(right.drawbar_pull_N, left.drawbar_pull_N, 1e-9);
    EXPECT_GT(right.sinkage_m, last);
    last = right.sinkage_m;
  }
}

TEST(EffectsDigging, SlipSinkageMatchesLinearAndReeceLaws) {
  for (const double slip : {-0.6, 0.0, 0.4, 0.8}) {
    const double z0 = predict(base(), straightOn(slip)).sinkage_m, i = std::max(0.0, slip);
    RefinedModel model = base();
    model.effects = {with("slip_sinkage_linear", {0.5})};
    // Closed form: z0 (1 + a i), and z0 + a h i / (1 - i) with h = 10 mm; a braked wheel does not dig by
    // these effects.
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i), 1e-9) << slip;
    model.effects = {with("slip_sinkage_reece", {0.4})};
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 + 0.4 * 0.01 * i / (1.0 - i), 1e-9) << slip;
    model.effects.push_back(with("slip_sinkage_linear", {0.5}));
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i) + 0.4 * 0.01 * i / (1.0 - i),
                1e-9);
  }
}

TEST(EffectsDigging, RearFillIncreasesPullAndDugDepthIsExcludedFromBulldozing) {
  RefinedModel model = base();
  model.effects = {with("slip_sinkage_linear", {1.0})};
  const Reading digs = predict(model, straightOn(0.6));
  model.effects.push_back(with("rear_fill", {1.0}));
  const Reading filled = predict(model, straightOn(0.6));
  // Property: contact behind the axle supports the wheel and adds thrust at the same sinkage.
  EXPECT_GT(filled.drawbar_pull_N, digs.drawbar_pull_N);
  EXPECT_EQ(filled.sinkage_m, digs.sinkage_m);
  EXPECT_NEAR(filled.dug_m, 0.6 / 1.6 * filled.sinkage_m, 1e-12);  // Closed form: z0 (1 + a i).
  model.effects.push_back(with("bulldozing_ahead", {2.0}));
  const double pushed = filled.sinkage_m - filled.dug_m,
               kp = std::pow(std::tan(0.25 * std::numbers::pi + 0.275), 2);
  // Closed form: a b gamma z_p^2 Kp / 2, gamma = 1600 kg/m^3 x 9.80665 m/s^2.
  EXPECT_NEAR(filled.drawbar_pull_N - predict(model, straightOn(0.6)).drawbar_pull_N,
              2.0 * state().wheel.width_m * 0.5 * 1600.0 * 9.80665 * pushed * pushed * kp, 1e-6);
}

TEST(EffectsDigging, PloughingGrowsWithTheLateralPathShare) {
  // Closed form: J = sin b / (sin b + m cos b) at 45 deg is 1/2 for m = 1 and 1/4 for m = 3; a r J^2 with
  // a r = 0.1 m, and contact behind 1 - (1 - J). The locked wheel has no other digging effect.
  const WheelContact one = acted("side_ploughing", {0.5, 1.0}, std::numbers::pi / 4),
                     three = acted("side_ploughing", {0.5, 3.0}, -std::numbers::pi / 4);
  EXPECT_NEAR(one.ploughed_m, 0.1 / 4, 1e-12);
  EXPECT_NEAR(one.rebound, 0.5, 1e-12);
  EXPECT_NEAR(three.ploughed_m, 0.1 / 16, 1e-12);
  EXPECT_NEAR(three.rebound, 0.25, 1e-12);
  WheelContact locked = plainContact();
  locked.rolling = 0.0;
  const double parameters[] = {0.5, 1.0};
  findEffect("side_ploughing")->act({parameters, {}, std::numbers::pi / 4}, locked);
  EXPECT_EQ(locked.ploughed_m, 0.0);
}

// A drift that begins at 100 s and has a span of 50 s.
constexpr double kStart = 100.0, kSpan = 50.0;

TEST(EffectsDrift, LinearDriftReachesItsSizeOverItsSpan) {
  // Closed form: 1 + a u with u = 1/2; k e^{a u}.
  const double middle = kStart + 0.5 * kSpan;
  EXPECT_NEAR(acted("drift_cohesion", {0.4, kStart, kSpan}, middle).cohesion_Pa, 1200.0, 1e-9);
  EXPECT_NEAR(acted("drift_friction", {0.4, kStart, kSpan}, middle).tan_friction, 0.6, 1e-12);
  EXPECT_NEAR(acted("drift_stiffness", {std::log(4.0), kStart, kSpan}, middle).sinkage_modulus, 2e6, 1e-6);
  EXPECT_EQ(acted("drift_cohesion", {0.4, kStart, kSpan}, kStart), plainContact());
}

TEST(EffectsDrift, RelaxingDriftReachesHalfItsSizeAfterLnTwoTimeConstants) {
  const double x = kStart + kSpan * 0.4 * std::log(2.0);
  EXPECT_NEAR(acted("drift_cohesion_relaxing", {0.4, kStart, kSpan, 0.4}, x).cohesion_Pa, 1200.0, 1e-9);
}

TEST(EffectsDrift, DiurnalDriftIsPeriodic) {
  const std::vector<double> wave{0.2, kStart, kSpan, 0.5, 0.0};  // period of half a span
  const auto cohesion = [&](double periods) {
    return acted("drift_cohesion_diurnal", wave, kStart + 0.5 * kSpan * periods).cohesion_Pa;
  };
  // Closed form: the sine's values at quarters of its period.
  EXPECT_NEAR(cohesion(0.25), 1200.0, 1e-9);
  EXPECT_NEAR(cohesion(0.75), 800.0, 1e-9);
  EXPECT_NEAR(cohesion(1.0), 1000.0, 1e-9);
}

TEST(EffectsDrift, SensorZeroDriftChangesItsChannelOnly) {
  const Reading before{
      .load_N = 100.0, .radius_m = 0.2, .sinkage_m = 0.01, .torque_Nm = 5.0, .drawbar_pull_N = 20.0};
  const auto moved = [&](const char* name) {
    return readWith(name, {3.0, kStart, kSpan}, kStart + kSpan, {}, plainContact(), before);
  };
  const Reading pull = moved("drift_drawbar_zero"), torque = moved("drift_torque_zero"),
                sinkage = moved("drift_sinkage_zero");
  EXPECT_EQ(pull.drawbar_pull_N, 23.0);
  EXPECT_EQ(torque.torque_Nm, 8.0);
  EXPECT_EQ(sinkage.sinkage_m, 3.01);
  EXPECT_EQ(pull.torque_Nm, 5.0);
  EXPECT_EQ(torque.drawbar_pull_N, 20.0);
  EXPECT_EQ(sinkage.drawbar_pull_N, 20.0);
}

// Property: an extrapolated drift leaves every soil parameter in its physical range.
TEST(EffectsDrift, ExtrapolatedDriftKeepsSoilPhysical) {
  const double far = kStart + 1000 * kSpan;
  EXPECT_EQ(acted("drift_cohesion", {-0.5, kStart, kSpan}, far).cohesion_Pa, 0.0);
  EXPECT_GT(acted("drift_friction", {-0.5, kStart, kSpan}, far).tan_friction, 0.0);
  EXPECT_LT(acted("drift_stiffness", {3.0, kStart, kSpan}, far).sinkage_modulus, 2e8);
}

TEST(EffectsDrift, OnlyZeroDriftsAreSensorFaults) {
  int forms = 0;
  for (const EffectForm& form : effectLibrary()) {
    if (std::string(form.family) != "drift") continue;
    ++forms;
    EXPECT_EQ(form.of_sensor, std::string(form.name).find("_zero") != std::string::npos) << form.name;
    EXPECT_FALSE(form.parameters[1].fitted) << form.name;  // start and span follow from the data
    EXPECT_FALSE(form.parameters[2].fitted) << form.name;
  }
  EXPECT_EQ(forms, 18);  // three soil targets and three sensor targets, in three shapes
}

TEST(EffectsForce, BulldozingScalesWithGravityWithoutCohesion) {
  RefinedModel model = base();
  model.soil.cohesion_Pa = 0.0;
  const auto resistance = [&](const char* effect, std::vector<double> parameters, double gravity_m_s2) {
    WheelState s = straightOn(0.6);
    s.gravity_m_s2 = gravity_m_s2;
    model.effects.clear();
    const double without = predict(model, s).drawbar_pull_N;
    model.effects = {with(effect, std::move(parameters))};
    return without - predict(model, s).drawbar_pull_N;
  };
  // Closed form: without cohesion the resistance is proportional to the soil's weight.
  const double earth = resistance("bulldozing", {1.0}, 9.80665), moon = resistance("bulldozing", {1.0}, 1.62);
  EXPECT_GT(moon, 0.0);
  EXPECT_NEAR(moon / earth, 1.62 / 9.80665, 1e-9);
}

TEST(EffectsForce, RoughFaceFrictionOpposesSlidingAndReducesSideForce) {
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
  // Property: friction acts against the sliding of the face over the soil.
  EXPECT_LT(added(-1.0, Channel::DrawbarPull), -0.01);
  EXPECT_GT(added(0.8, Channel::DrawbarPull), 0.01);
  // Property: friction along the face reduces the resistance sideways (side force < 0 against the motion).
  EXPECT_LT(added(-0.7, Channel::SideForce), added(0.8, Channel::SideForce));
  EXPECT_LT(added(0.8, Channel::SideForce), 0.0);
}

Reading sunk(double z_m) {
  return {.load_N = 100.0, .radius_m = 0.2, .sinkage_m = z_m};
}

WheelContact soilOf(double friction_angle_rad) {
  WheelContact c = plainContact();
  c.tan_friction = std::tan(friction_angle_rad);
  c.density_kg_m3 = 1500.0;
  c.gravity_m_s2 = 10.0;
  return c;
}

TEST(EffectsForce, BulldozingMatchesThePassiveWedge) {
  // Closed form: Kp = 3 at 30 deg; b (gamma z^2 Kp / 2 + 2 c z sqrt(Kp)), b = 0.1 m, z = 0.02 m.
  const double friction = 0.1 * 15000.0 * 0.0004 * 3.0 / 2.0,
               cohesion = 0.1 * 2.0 * 1000.0 * 0.02 * std::sqrt(3.0);
  const WheelContact c = soilOf(std::numbers::pi / 6);
  EXPECT_NEAR(readWith("bulldozing", {2.0}, 0.02, {}, c, sunk(0.02)).drawbar_pull_N,
              -2.0 * (friction + cohesion), 1e-9);
  EXPECT_NEAR(readWith("bulldozing_two_term", {3.0, 0.5}, 0.02, {}, c, sunk(0.02)).drawbar_pull_N,
              -(3.0 * friction + 0.5 * cohesion), 1e-9);
  // Closed form: X = 45 deg at phi = 0, so b 2 (z c + gamma z^2 / 2).
  EXPECT_NEAR(readWith("bulldozing_hegedus", {1.0}, 0.02, {}, soilOf(0.0), sunk(0.02)).drawbar_pull_N,
              -0.2 * (0.02 * 1000.0 + 0.5 * 15000.0 * 0.0004), 0.02);  // tan phi is at least 0.001
}

// Property: a wheel that moves normal to its plane pushes no soil ahead.
TEST(EffectsForce, BulldozingAheadIsZeroAtNinetyDegrees) {
  const WheelState across{.slip_angle_rad = std::numbers::pi / 2};
  for (const char* name : {"bulldozing", "bulldozing_hegedus", "bulldozing_ahead"})
    EXPECT_NEAR(readWith(name, {1.0}, 0.02, across, soilOf(0.5), sunk(0.02)).drawbar_pull_N, 0.0, 1e-9)
        << name;
}

TEST(EffectsForce, SmoothFaceCoulombPressureEqualsRankine) {
  // Closed form: Coulomb's passive coefficient without wall friction is tan^2(45 deg + phi/2).
  for (const double angle : {-1.0, 0.3, 1.4}) {
    const WheelContact c = soilOf(0.6);
    const Reading plain = readWith("side_bulldozing", {1.0}, angle, {}, c, sunk(0.03));
    const Reading rough = readWith("side_bulldozing_rough", {1.0, 0.0}, angle, {}, c, sunk(0.03));
    EXPECT_NEAR(rough.side_force_N, plain.side_force_N, 1e-9 * std::abs(plain.side_force_N));
    EXPECT_EQ(rough.drawbar_pull_N, 0.0);
    EXPECT_LT(plain.side_force_N * angle, 0.0);
  }
}

TEST(EffectsForce, RearPileAndSlopeWeightComponentMatchClosedForm) {
  const WheelContact c = soilOf(std::numbers::pi / 6);
  // Closed form: a W (i - i0)^2 = 0.5 x 100 x 0.04; gamma b h^2 Kp / 2 with h = 0.5 x 0.2; 0 below i0.
  EXPECT_NEAR(readWith("rear_pile", {0.5, 0.4}, 0.6, {}, c, sunk(0.01)).drawbar_pull_N, 2.0, 1e-12);
  EXPECT_EQ(readWith("rear_pile", {0.5, 0.4}, 0.3, {}, c, sunk(0.01)).drawbar_pull_N, 0.0);
  EXPECT_NEAR(readWith("rear_pile_passive", {0.5, 0.4}, 0.6, {}, c, sunk(0.01)).drawbar_pull_N,
              15000.0 * 0.1 * 0.01 * 3.0 / 2.0, 1e-9);
  EXPECT_NEAR(
      readWith("slope_weight_component", {0.5}, std::numbers::pi / 6, {}, c, sunk(0.01)).drawbar_pull_N,
      -25.0, 1e-12);
}

TEST(EffectsForce, RoughFaceMatchesCoulombPressure) {
  // Closed form: phi = delta = 30 deg gives Kp = cos 30 deg / (1 - sqrt(1/2))^2 = 10.095. The pushed soil
  // moves only upwards along the face of a locked wheel at 90 deg: all friction increases the pressure, and
  // the pull is 0.
  WheelContact c = soilOf(std::numbers::pi / 6);
  c.cohesion_Pa = 0.0;
  c.rolling = 0.0;
  const double kp = std::cos(std::numbers::pi / 6) / std::pow(1.0 - std::sqrt(0.5), 2);
  const double z = 0.02, chord = 2.0 * std::sqrt(z * (0.4 - z));
  const Reading r = readWith("side_bulldozing_rough", {1.0, std::tan(std::numbers::pi / 6)},
                             std::numbers::pi / 2, {}, c, sunk(z));
  EXPECT_NEAR(r.side_force_N, -chord * 0.5 * 15000.0 * z * z * kp, 1e-9);
  EXPECT_NEAR(r.drawbar_pull_N, 0.0, 1e-9);
}

TEST(EffectsForce, SideEffectsReplaceTheSideTermsOfTheBase) {
  RefinedModel model = base();
  const Reading plain = predict(model, state());
  RefinedModel bare = model;
  bare.soil.digging_exponent = bare.soil.side_bulldozing = 0.0;
  // Property: a form with parameter 0 switches off the corresponding term of the base, and no other term.
  model.effects = {with("side_bulldozing", {0.0}), with("side_slip_sinkage", {0.0})};
  const Reading none = predict(model, state()), want = predict(bare, state());
  EXPECT_EQ(none.side_force_N, want.side_force_N);
  EXPECT_EQ(none.sinkage_m, want.sinkage_m);
  model.effects = {with("side_bulldozing", {0.0})};
  EXPECT_EQ(predict(model, state()).sinkage_m, plain.sinkage_m);
  EXPECT_GT(std::abs(plain.side_force_N), std::abs(predict(model, state()).side_force_N));
}

TEST(EffectsForce, BaseAtSlipAngleMatchesTheEquilibrium) {
  for (const double slip : {-1.0, -0.4, 0.0, 0.3, 0.9}) {
    const WheelState s = state(slip);
    const Reading r = predict(base(), s);
    const WheelForces f = equilibrium(base().soil, s.wheel,
                                      {.load_N = s.load_N, .slip = slip, .slip_angle_rad = s.slip_angle_rad});
    // Property: two solvers of one wheel agree. Tolerance: 1e-4 for the faster quadrature of a sliding wheel.
    EXPECT_NEAR(r.side_force_N / s.load_N, f.side_force_N / s.load_N, 1e-4) << slip;
    EXPECT_NEAR(r.drawbar_pull_N / s.load_N, f.drawbar_pull_N / s.load_N, 1e-4) << slip;
    EXPECT_NEAR(r.sinkage_m / f.sinkage_m, 1.0, 1e-4) << slip;
  }
}

const Reading kRead{
    .load_N = 100.0, .radius_m = 0.2, .sinkage_m = 0.01, .torque_Nm = 6.0, .drawbar_pull_N = 20.0};

Reading read(const char* name, std::vector<double> parameters, double x = 1.0, double slip = 0.2) {
  return readWith(name, std::move(parameters), x, {.slip = slip}, plainContact(), kRead);
}

TEST(EffectsSensor, TorqueEffectsAddOffsetViscousFrictionAndEfficiency) {
  EXPECT_DOUBLE_EQ(read("torque_offset", {0.5}).torque_Nm, 6.5);
  EXPECT_DOUBLE_EQ(read("torque_offset", {0.5}, 1.0, -1.0).torque_Nm, 6.0);  // a locked wheel does not turn
  EXPECT_DOUBLE_EQ(read("torque_offset_viscous", {0.5, 10.0}, 0.1).torque_Nm, 7.5);
  EXPECT_DOUBLE_EQ(read("torque_efficiency", {0.75}).torque_Nm, 8.0);
}

TEST(EffectsSensor, DrawbarZeroSinkageDatumAndCellTiltMatchClosedForm) {
  EXPECT_DOUBLE_EQ(read("drawbar_zero", {-3.0}).drawbar_pull_N, 17.0);
  EXPECT_DOUBLE_EQ(read("sinkage_datum", {0.002}).sinkage_m, 0.012);
  // Closed form: DP cos e + W sin e at 30 deg.
  EXPECT_NEAR(read("load_cell_tilt", {std::numbers::pi / 6}).drawbar_pull_N, 10.0 * std::sqrt(3.0) + 50.0,
              1e-12);
}

// Closed form: 1 - i = (1 - i_m)/(1 + e); a radius taken 25 % too small turns a slip of 0.2 into 0.36.
TEST(EffectsSensor, SlipBiasEqualsARadiusError) {
  const auto slip = [](double measured, double e) {
    WheelContact c = plainContact();
    c.slip = measured;
    findEffect("slip_bias")->act({&e, {}, measured}, c);
    return c.slip;
  };
  EXPECT_NEAR(slip(0.2, 0.25), 0.36, 1e-12);
  EXPECT_NEAR(slip(0.2, -0.2), 0.0, 1e-12);
  EXPECT_EQ(slip(1.0, 0.25), 1.0);
  EXPECT_EQ(slip(-0.3, 0.25), -0.3);  // no correction for a braked wheel
}

TEST(EffectsSensor, OnlySensorEffectsAreMarkedAsSensorFaults) {
  for (const EffectForm& form : detail::sensorEffects()) EXPECT_TRUE(form.of_sensor) << form.name;
  for (const EffectForm& form : detail::forceEffects()) EXPECT_FALSE(form.of_sensor) << form.name;
  for (const EffectForm& form : detail::contactEffects()) EXPECT_FALSE(form.of_sensor) << form.name;
}

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
