#include <cmath>
#include <numbers>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_contact_test {

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

}  // namespace effects_contact_test
}  // namespace talus::terramech
