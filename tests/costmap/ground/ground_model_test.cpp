#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::costmap {
namespace ground_model_test {

double pull(const terramech::Soil& soil) {
  return terramech::mobilityReference(terramech::onSoil(soil), testRover()).drawbar_pull_over_load;
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
  EXPECT_LT(terramech::mobilityReference(modelOf(ground), testRover()).drawbar_pull_over_load,
            pull(testSand()));
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
      std::vector<float> before;
      for (double std = 0.0, loss = 0.0; std < 0.5;
           std += drawn(random, 0.0, 0.1), loss += drawn(random, 0.0, 0.02)) {
        GroundBelief belief = departed(model, pull - loss, std);
        belief.sinkage.value = 0.0;
        const TravelCurve now = model.ground(0, belief).curve;
        for (std::size_t i = 0; std > 0.0 && i < now.costs->size(); ++i) {
          ASSERT_GE((*now.costs)[i], 0.995F * before[i]) << trial << ' ' << k << ' ' << std << ' ' << i;
          compared += std::isfinite((*now.costs)[i]);
        }
        for (std::size_t bin = TravelCurve::kBins / 2; bin + 1 < TravelCurve::kBins; ++bin)
          ASSERT_GE(now.level()[bin + 1], 0.995F * now.level()[bin]) << trial << ' ' << k << ' ' << bin;
        before = *now.costs;
      }
    }
  }
  EXPECT_GT(compared, 2000) << "most of what was compared was refused";
}

using terramech::Category;

GroundBelief certain(const GroundModel& model) {
  GroundBelief belief = model.prior(0);
  belief.pull.std = 0.0;
  return belief;
}

// Property: the steepest slope that is not refused exceeds that of the soil by less than 0.02 on average,
// and by more than 0.03 for at most 6 soils. Soils are drawn about the class, and each estimate has the true
// pull of its soil at the reference slip.
TEST(GroundModel, MaximumSlopeOfRandomSoilsIsNotOverestimated) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  GroundModel::Parts parts = testGround()->parts();
  // Soils of the library, without their standard deviations of pressure and sinkage.
  terramech::SoilPrior crusty, loam;
  crusty.mean = {.name = "mars_crusty",
                 .cohesion_Pa = 1100,
                 .friction_angle_rad = 0.602,
                 .sinkage_exponent = 0.85,
                 .frictional_modulus = 1750e3,
                 .shear_modulus_m = 0.020,
                 .c1 = 0.43,
                 .c2 = 0.32};
  crusty.deviation = {.cohesion_Pa = 800, .friction_angle_rad = 0.082, .shear_modulus_m = 0.0058};
  loam.mean = {.name = "sandy_loam",
               .cohesion_Pa = 7445,
               .friction_angle_rad = 0.44,
               .sinkage_exponent = 0.7,
               .cohesive_modulus = 5270,
               .frictional_modulus = 1515e3,
               .shear_modulus_m = 0.020,
               .c1 = 0.43,
               .c2 = 0.32};
  loam.deviation = {.cohesion_Pa = 3663, .friction_angle_rad = 0.143, .shear_modulus_m = 0.0058};
  for (const terramech::SoilPrior& prior : {crusty, loam}) {
    const std::string& name = prior.mean.name;
    parts.classes = {groundClass(0, prior, parts.rover)};
    parts.policy.allow_dangerous = true;
    const GroundModel model(parts);
    int weak = 0, promised = 0;
    double sum = 0.0;
    while (weak < 60) {
      terramech::Soil soil = prior.mean;
      soil.cohesion_Pa = std::max(0.0, soil.cohesion_Pa + prior.deviation.cohesion_Pa * normal(random));
      soil.friction_angle_rad =
          std::max(0.15, soil.friction_angle_rad + prior.deviation.friction_angle_rad * normal(random));
      soil.shear_modulus_m =
          std::max(0.004, soil.shear_modulus_m + prior.deviation.shear_modulus_m * normal(random));
      const auto own = terramech::SlopeEquilibrium(soil, parts.rover).withoutRuts();
      const auto reference = terramech::mobilityReference(terramech::onSoil(soil), parts.rover);
      GroundBelief belief = model.prior(0);
      if (belief.pull.value - reference.drawbar_pull_over_load < 0.03) continue;
      ++weak;
      double steepest = -0.3;
      while (own.at({steepest + 0.002, 0.0}).grip == terramech::SlopeFailure::None) steepest += 0.002;
      belief.pull = {reference.drawbar_pull_over_load, 0.0};
      belief.sinkage = {reference.sinkage_over_radius, 0.0};
      double allowed = -0.3;
      while (model.state(0, belief, allowed + 0.002).refusal == Refusal::None) allowed += 0.002;
      sum += allowed - steepest;
      promised += allowed > steepest + 0.03 ? 1 : 0;
    }
    EXPECT_LE(promised, 6) << name;
    EXPECT_LT(std::abs(sum / weak), 0.02) << name;
  }
}

TEST(GroundModel, FollowingWheelsUseMultipassEffects) {
  GroundModel::Parts parts = testGround()->parts();
  const GroundModel plain(parts);
  parts.classes[0].effects = {
      {.name = "multipass_reload", .covariate = "pass_index", .parameters = {3.0, 1.0}}};
  const GroundModel model(parts);
  for (const double gradient : {0.0, 0.08}) {
    // Property: a multipass effect with the factors of rutted() gives the same ruts.
    EXPECT_NEAR(model.state(0, certain(model), gradient).slip, plain.state(0, certain(plain), gradient).slip,
                0.02);
  }
  // Estimates refer to a wheel on fresh ground, with and without ruts. Tolerance: two quadrature rules of
  // one integral, 1e-6 apart.
  EXPECT_NEAR(model.prior(0).pull.value, plain.prior(0).pull.value, 1e-5);
  EXPECT_NEAR(model.steady(0, {.slip = 0.3}).drawbar_pull_over_load,
              plain.steady(0, {.slip = 0.3}).drawbar_pull_over_load, 1e-4);
  EXPECT_GT(model.steady(0, {.slip = 0.3, .in_rut = true}).drawbar_pull_over_load,
            model.steady(0, {.slip = 0.3}).drawbar_pull_over_load);
}

TEST(GroundModel, CategoryProbabilityIsTheNormalTailProbability) {
  const auto model = testGround();
  const double edge = std::tan(model->parts().policy.slope_margin_rad);
  const RankedCategory ranked = model->category({.pull = {edge + 0.05, 0.05}, .sinkage = {0.1, 0.0}}, 0.0);
  EXPECT_EQ(ranked.category, Category::Safe);
  // Closed form: P(pull > edge) for a mean one standard deviation above the edge.
  EXPECT_NEAR(ranked.probability, 0.5 * std::erfc(-1.0 / std::numbers::sqrt2), 1e-12);
}

TEST(GroundModel, InfeasibilityNamesItsReason) {
  const auto model = testGround();
  GroundBelief belief = certain(*model);
  EXPECT_EQ(model->state(0, belief, 0.0).refusal, Refusal::None);
  GroundBelief weak = belief;
  weak.pull.value -= 0.3;
  EXPECT_EQ(model->state(0, weak, 0.2).refusal, Refusal::Pull);
  belief.sinkage.value *= 1e3;
  EXPECT_EQ(model->state(0, belief, 0.0).refusal, Refusal::Sinkage);
}

TEST(GroundModel, CostIsFiniteExactlyWhereTheStateIsFeasible) {
  const auto model = testGround();
  const TravelCost cost(model->limits(),
                        {model->ground(0, model->prior(0)), model->ground(1, model->prior(1))});
  for (const double slope : {0.0, 0.1, 0.2, 0.3, 0.5})
    for (int step = 0; step < 32; ++step) {
      const double angle = step * std::numbers::pi / 16.0;
      const CellCode cell({.dz_dx = slope, .dz_dy = 0.0, .curve = static_cast<std::uint8_t>(step % 2)});
      const Direction heading{std::cos(angle), std::sin(angle)};
      const TravelState state = cost.detail(cell, heading);
      EXPECT_EQ(std::isfinite(cost.costPerMetre(cell, heading)), state.refusal == Refusal::None)
          << slope << " " << angle;
    }
}

TEST(GroundModel, EmptyAndDuplicateClassesAreRejected) {
  GroundModel::Parts parts{.rover = testRover(), .classes = {}, .policy = {}};
  EXPECT_REFUSED(GroundModel{parts}, std::invalid_argument, "classes is empty, must hold at least one");
  parts.classes = {GroundClass{.number = 1, .soil = testSand()},
                   GroundClass{.number = 1, .soil = testDust()}};
  EXPECT_REFUSED(GroundModel{parts}, std::invalid_argument, "class 1 is declared twice");
}

// Property: concurrent first requests of lazily computed results return the result of a single thread.
TEST(GroundModel, ConcurrentRequestsYieldTheSingleThreadedResult) {
  const auto together = testGround(), alone = testGround();
  const GroundModel copy = *together;
  std::array<TravelState, 4> states;
  {
    std::array<std::jthread, 4> threads;
    for (std::size_t k = 0; k < threads.size(); ++k)
      threads[k] = std::jthread([&, k] {
        const GroundModel& model = k % 2 == 0 ? *together : copy;
        states[k] = model.state(1, model.prior(1), 0.1);
      });
  }
  const TravelState expected = alone->state(1, alone->prior(1), 0.1);
  for (const TravelState& state : states) {
    EXPECT_EQ(state.energy_J_per_m, expected.energy_J_per_m);
    EXPECT_EQ(state.weak, expected.weak);
  }
  EXPECT_EQ(together->lattice(1), copy.lattice(1)) << "copies share what was worked out";
}

// Property: the soil of a lazily computed class is validated at construction.
TEST(GroundModel, InvalidSoilOfAnUnusedClassIsRejected) {
  GroundModel::Parts parts = testGround()->parts();
  parts.classes.push_back({.number = 9, .soil = testSand()});
  parts.classes.back().soil.friction_angle_rad = -1.0;
  EXPECT_REFUSED(GroundModel{parts}, std::invalid_argument,
                 "friction_angle_rad = -1, must be in [0, 1.5708]");
}

TEST(GroundModel, SteadyWheelMatchesTheForwardModel) {
  const auto model = testGround();
  const terramech::Rover rover = testRover();
  for (const double slip : {0.1, 0.3, 0.5}) {
    const SteadyWheel steady = model->steady(0, {.slip = slip});
    const double load_N = terramech::wheelLoad_N(rover) / std::hypot(1.0, steady.drawbar_pull_over_load);
    const auto wheel = terramech::equilibrium(testSand(), rover.wheel, {.load_N = load_N, .slip = slip});
    // Closed form: the wheel under its load on that slope. Tolerance: the table of the curve, 1e-3 in slip.
    EXPECT_NEAR(steady.drawbar_pull_over_load, wheel.drawbar_pull_N / load_N, 5e-3) << slip;
    EXPECT_NEAR(steady.sinkage_over_radius, wheel.sinkage_m / rover.wheel.radius_m, 2e-3) << slip;
    EXPECT_NEAR(steady.torque_over_load_radius, wheel.torque_Nm / (load_N * rover.wheel.radius_m), 5e-3)
        << slip;
    EXPECT_LT(model->steady(0, {.slip = slip, .in_rut = true}).sinkage_over_radius,
              0.6 * steady.sinkage_over_radius);
  }
  EXPECT_DOUBLE_EQ(model->reference(0, false).drawbar_pull_over_load, model->prior(0).pull.value);
}

TEST(GroundModel, CategoryThresholdsAreTangentsOfSlopePlusMinusMargin) {
  const auto model = testGround();
  const double margin = model->parts().policy.slope_margin_rad;
  for (const double slope : {-0.3, 0.0, 0.1, 0.4}) {
    // Closed form: thesis 3.5, safe above tan(slope + margin), dangerous below tan(slope - margin)
    const auto of = [&](double pull) {
      return model->category({.pull = {pull, 0.0}, .sinkage = {0.1, 0.0}}, std::tan(slope)).category;
    };
    EXPECT_EQ(of(std::tan(slope + margin) + 1e-9), terramech::Category::Safe);
    EXPECT_EQ(of(std::tan(slope + margin) - 1e-9), terramech::Category::Marginal);
    EXPECT_EQ(of(std::tan(slope - margin) + 1e-9), terramech::Category::Marginal);
    EXPECT_EQ(of(std::tan(slope - margin) - 1e-9), terramech::Category::Dangerous);
  }
}

}  // namespace ground_model_test
}  // namespace talus::costmap
