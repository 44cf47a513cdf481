#include <cmath>
#include <numbers>

#include <talus/terramech/contact/wong_reece.hpp>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_force_test {

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

}  // namespace effects_force_test
}  // namespace talus::terramech
