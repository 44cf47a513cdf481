#include <cmath>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

namespace ground_states_test {

double drawn(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

terramech::Soil anySoil(std::mt19937_64& random) {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = drawn(random, 0.0, 3000.0);
  soil.friction_angle_rad = drawn(random, 0.3, 0.75);
  soil.sinkage_exponent = drawn(random, 0.6, 1.3);
  soil.frictional_modulus = std::exp(drawn(random, std::log(5e4), std::log(3e6)));
  soil.shear_modulus_m = drawn(random, 0.005, 0.03);
  return soil;
}

terramech::Rover anyRover(std::mt19937_64& random) {
  terramech::Rover rover = testRover();
  rover.mass_kg = drawn(random, 10.0, 300.0);
  rover.wheel.radius_m = drawn(random, 0.08, 0.25);
  rover.wheel.width_m = drawn(random, 0.06, 0.25);
  rover.clearance_m = drawn(random, 0.05, 0.4);
  rover.max_torque_Nm = drawn(random, 2.0, 60.0);
  return rover;
}

GroundBelief departed(const GroundModel& model, double pull, double std) {
  GroundBelief belief = model.prior(0);
  belief.pull = {belief.pull.value + pull, std};
  return belief;
}

double strengthOf(const GroundModel& model, double pull) {
  return 1.0 + pull / model.reference(0, false).torque_over_load_radius;
}

TEST(GroundStates, CertainGroundHasTheStateOfTheEquilibrium) {
  const auto model = testGround();
  const terramech::SlopeEquilibrium exact(testSand(), testRover());
  for (const double pull : {-0.03, 0.0, 0.05})
    for (const double gradient : {-0.2, -0.05, 0.0, 0.05, 0.08}) {
      const terramech::SlopeState want = exact.at({gradient, 0.0}, strengthOf(*model, pull));
      if (!want.holds()) continue;
      const TravelState state = model->state(0, departed(*model, pull, 0.0), gradient);
      // Closed form. Tolerance: linear interpolation over the strength and between gradients 1/64 apart.
      EXPECT_NEAR(state.slip, want.slip, 0.01) << pull << ' ' << gradient;
      const double metre_J = want.energy_J_per_m * std::hypot(1.0, gradient);
      EXPECT_NEAR(state.energy_J_per_m, metre_J, 0.02 * metre_J) << pull << ' ' << gradient;
    }
}

// Closed form, by brute force: the mean over a fine grid of strengths; a failed attempt costs twice the metre at
// the least strength that holds.
TEST(GroundStates, ForecastAndCostAreExpectations) {
  const auto model = testGround();
  const terramech::SlopeEquilibrium exact(testSand(), testRover());
  const double gradient = 0.21875, std = 0.04, thrust = model->reference(0, false).torque_over_load_radius;
  const double least = exact.leastStrength({gradient, 0.0}),
               limit_J = exact.at({gradient, 0.0}, least).energy_J_per_m;
  double forecast = 0.0, held = 0.0, cost = 0.0, weight = 0.0;
  for (double u = -6.0; u <= 6.0; u += 0.01) {
    const double strength = 1.0 + u * std / thrust, w = std::exp(-0.5 * u * u);
    const bool holds = strength >= least;
    const double metre_J = holds ? exact.at({gradient, 0.0}, strength).energy_J_per_m : limit_J;
    forecast += holds ? w * metre_J : 0.0;
    held += holds ? w : 0.0;
    cost += w * (holds ? metre_J : 2.0 * metre_J);
    weight += w;
  }
  GroundModel::Parts parts = model->parts();
  parts.policy.time_weight_W = parts.policy.risk_weight_J = 0.0;
  const GroundModel energy_alone(parts);
  const GroundBelief belief = departed(*model, 0.0, std);
  ASSERT_GT(1.0 - held / weight, 0.001);
  const double surface = std::hypot(1.0, gradient);
  EXPECT_NEAR(model->state(0, belief, gradient).energy_J_per_m, surface * forecast / held,
              0.02 * forecast / held);
  EXPECT_NEAR(energy_alone.ground(0, belief).curve.price(gradient, 0.0), surface * cost / weight,
              0.02 * cost / weight);
  // Closed form: the decision does not count on ruts.
  const double reserve = 1.0 - exact.withoutRuts().leastStrength({gradient, 0.0});
  EXPECT_NEAR(model->state(0, belief, gradient).weak,
              0.5 * std::erfc(reserve * thrust / std / std::sqrt(2.0)), 1e-3);
}

// Property: neither cost nor risk decreases as the standard deviation grows or the pull falls, at any gradient
// along and across, and costs rise with the climb, for random rovers, soils and estimates. Tolerance 0.5 %: as
// CostCurveTable.TabulatedCostIsNeverBelowTheExactCost.
TEST(GroundStates, CostIsMonotoneInDoubtWeaknessAndClimb) {
  std::mt19937_64 random(11);
  int compared = 0;
  for (int trial = 0; trial < 12; ++trial) {
    GroundModel::Parts parts{.rover = anyRover(random), .classes = {{.soil = anySoil(random)}}, .policy = {}};
    parts.rover.max_torque_Nm = 1e3;  // a wheel that slips more needs less torque and may sink less
    parts.policy.allow_dangerous = trial % 2 == 0;
    parts.policy.max_immobilisation = trial % 3 == 0 ? 1.0 : 0.5;
    const GroundModel model(parts);
    for (int k = 0; k < 4; ++k) {
      const double pull = drawn(random, -0.3, 0.3);
      TravelCurve before;
      for (double std = 0.0, loss = 0.0; std < 0.5;
           std += drawn(random, 0.0, 0.1), loss += drawn(random, 0.0, 0.02)) {
        GroundBelief belief = departed(model, pull - loss, std);
        belief.sinkage.value = 0.0;
        const TravelCurve now = model.ground(0, belief).curve;
        for (std::size_t i = 0; std > 0.0 && i < now.crossing->size(); ++i) {
          ASSERT_GE((*now.crossing)[i], 0.995F * (*before.crossing)[i])
              << trial << ' ' << k << ' ' << std << ' ' << i;
          compared += std::isfinite((*now.crossing)[i]);
        }
        for (std::size_t bin = TravelCurve::kBins / 2; bin + 1 < TravelCurve::kBins; ++bin)
          ASSERT_GE(now.cost_J_per_m[bin + 1], 0.995F * now.cost_J_per_m[bin])
              << trial << ' ' << k << ' ' << bin;
        before = now;
      }
    }
  }
  EXPECT_GT(compared, 2000) << "most of what was compared was refused";
}

double pull(const terramech::Soil& soil) {
  return terramech::mobilityReference(soil, testRover()).drawbar_pull_over_load;
}

TEST(GroundClass, SoilStdIsPropagatedToPullStd) {
  const terramech::SoilPrior prior{.mean = testSand(), .deviation = {.friction_angle_rad = 0.05}};
  terramech::Soil weaker = testSand(), stronger = testSand();
  weaker.friction_angle_rad -= 0.025;
  stronger.friction_angle_rad += 0.025;
  // Closed form: central difference of the one uncertain parameter.
  EXPECT_NEAR(groundClass(1, prior, testRover()).mean_std, pull(stronger) - pull(weaker), 1e-12);
}

// Property: the error message states the given standard deviation, not the soil parameter outside its
// range at which the central difference is evaluated.
TEST(GroundClass, StdOutsideTheSoilRangeIsReported) {
  const terramech::SoilPrior prior{.mean = testSand(), .deviation = {.cohesion_Pa = 1e12}};
  EXPECT_THAT(
      [&] { groundClass(1, prior, testRover()); },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(" with half of its std 1e+12")));
}

TEST(GroundClass, WithoutSoilStdTheDefaultStdIsUsed) {
  EXPECT_EQ(groundClass(1, {.mean = testSand(), .deviation = {}}, testRover()).mean_std,
            GroundClass{}.mean_std);
}

// Property: a test under the Earth's gravity yields weaker and less certain ground on the Moon; under the
// test's own gravity the values are unchanged.
TEST(GroundClass, LowerGravityThanTestedWeakensAndIncreasesStd) {
  terramech::SoilPrior prior{.mean = testSand(), .deviation = {}};
  terramech::Rover rover = testRover();
  const GroundClass as_stated = groundClass(1, prior, rover);
  prior.mean.test_gravity_m_s2 = rover.gravity_m_s2;
  EXPECT_EQ(groundClass(1, prior, rover).mean_std, as_stated.mean_std);
  EXPECT_EQ(groundClass(1, prior, rover).soil.frictional_modulus, as_stated.soil.frictional_modulus);
  prior.mean.test_gravity_m_s2 = 4.0 * rover.gravity_m_s2;
  const GroundClass weaker = groundClass(1, prior, rover);
  EXPECT_DOUBLE_EQ(weaker.soil.frictional_modulus, 0.25 * as_stated.soil.frictional_modulus);
  EXPECT_LT(pull(weaker.soil), pull(as_stated.soil));
  terramech::Soil half = testSand();
  half.cohesion_Pa *= 0.5;
  half.frictional_modulus *= 0.5;
  half.cohesive_modulus *= 0.5;
  EXPECT_NEAR(weaker.mean_std, std::hypot(as_stated.mean_std, pull(half) - pull(weaker.soil)), 1e-12);
}

terramech::RefinedModel digging() {
  terramech::RefinedModel model;
  model.soil = testSand();
  model.effects = {{.name = "slip_sinkage_ding", .covariate = "slip", .parameters = {0.5}},
                   {.name = "load_cell_tilt", .covariate = "constant", .parameters = {0.1}}};
  model.fitted = {{.effect = 0, .index = 0}};
  model.covariance = {0.0016};
  return model;
}

TEST(GroundClass, RefinedModelKeepsItsGroundEffects) {
  const GroundClass ground = groundClass(3, digging(), testRover());
  ASSERT_EQ(ground.effects.size(), 1U);
  EXPECT_EQ(ground.effects[0].name, "slip_sinkage_ding");
  // Property: slip sinkage makes the wheel sink deeper than in plain sand and weakens the pull at the
  // reference slip.
  EXPECT_LT(referenceOf(ground, testRover()).drawbar_pull_over_load, pull(testSand()));
}

TEST(GroundClass, PullStdFollowsFromTheModelCovariance) {
  terramech::RefinedModel more = digging(), less = digging();
  more.effects[0].parameters[0] += 0.004;
  less.effects[0].parameters[0] -= 0.004;
  const auto at = [](const terramech::RefinedModel& m) {
    return terramech::mobilityReference(m, testRover()).drawbar_pull_over_load;
  };
  // Closed form: |dDP/dn1| times the standard deviation 0.04. Tolerance 2 %: a central against a one-sided
  // difference.
  const double expected = std::abs(at(more) - at(less)) / 0.008 * 0.04;
  EXPECT_NEAR(groundClass(3, digging(), testRover()).mean_std, expected, 0.02 * expected);
}

}  // namespace ground_states_test

}  // namespace talus::costmap
