#include <cmath>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/cost/expected_travel.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {
namespace expected_travel_test {

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

TEST(ExpectedTravel, ZeroStandardDeviationYieldsTheMobilityCurve) {
  const terramech::MobilityCurve curve(testSand(), testRover());
  const ExpectedTravel drive(curve);
  for (const double demand : {-0.3, -0.05, 0.0, 0.07, 0.15}) {
    const terramech::MobilityState exact = curve.at(std::atan(demand));
    const ExpectedCost cost = drive.at({demand, 0.0}, -1.0);
    // Closed form: with zero standard deviation the expected cost is the cost. Tolerance: a table of 1024
    // steps.
    EXPECT_NEAR(cost.energy_J_per_m, exact.energy_J_per_m, 1e-5 * exact.energy_J_per_m);
    EXPECT_NEAR(cost.time_s_per_m * exact.speed_mps, 1.0, 1e-5);
  }
}

TEST(ExpectedTravel, CostIsTheExpectationOverTheDemandDistribution) {
  const terramech::MobilityCurve curve(testSand(), testRover());
  const ExpectedTravel drive(curve);
  const Estimate demand{0.05, 0.03};
  // Closed form, by brute force: the mean over a fine grid of demands; a failed demand costs twice the cost
  // at the limit.
  double sum = 0.0, weight = 0.0;
  for (double u = -6.0; u <= 6.0; u += 0.001) {
    const double at = demand.value + u * demand.std, w = std::exp(-0.5 * u * u);
    const double most = curve.at(std::atan(drive.last())).energy_J_per_m;
    sum += w * (at > drive.last() ? 2.0 * most : curve.at(std::atan(at)).energy_J_per_m);
    weight += w;
  }
  EXPECT_NEAR(drive.at(demand, -1.0).energy_J_per_m, sum / weight, 1e-3 * sum / weight);  // seven-point rule
}

// Property: neither cost nor risk decreases as a standard deviation grows, for random rovers, soils and
// estimates.
TEST(ExpectedTravel, CostIsMonotoneInStandardDeviation) {
  std::mt19937_64 random(11);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    GroundModel::Parts parts{.rover = anyRover(random), .classes = {{.soil = anySoil(random)}}, .policy = {}};
    parts.policy.allow_dangerous = trial % 2 == 0;
    parts.policy.max_immobilisation = trial % 3 == 0 ? 1.0 : 0.5;
    const GroundModel model(parts);
    for (int k = 0; k < 40; ++k) {
      GroundBelief belief = model.prior(0);
      belief.pull.value += drawn(random, -0.3, 0.3);
      belief.sinkage.value *= drawn(random, 0.5, 4.0);
      const double gradient = drawn(random, -0.4, 0.5);
      belief.pull.std = 0.0;
      TravelState before = model.state(0, belief, gradient);
      for (double std = drawn(random, 0.0, 0.01); std < 0.6; std += drawn(random, 0.0, 0.04)) {
        belief.pull.std = std;
        const TravelState now = model.state(0, belief, gradient);
        ASSERT_GE(model.cost_J_per_m(now), model.cost_J_per_m(before))
            << trial << ' ' << k << " std " << std << " gradient " << gradient;
        ASSERT_GE(now.risk_per_m, before.risk_per_m) << trial << ' ' << k << " std " << std;
        compared += now.refusal == Refusal::None;
        before = now;
      }
    }
  }
  EXPECT_GT(compared, 2000) << "most of what was compared was refused";
}

// Property: uphill, neither cost nor risk decreases as the gradient grows.
TEST(ExpectedTravel, CostIsMonotoneInUphillGradient) {
  std::mt19937_64 random(12);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    GroundModel::Parts parts{.rover = anyRover(random), .classes = {{.soil = anySoil(random)}}, .policy = {}};
    parts.policy.allow_dangerous = trial % 2 == 0;
    const GroundModel model(parts);
    for (int k = 0; k < 10; ++k) {
      GroundBelief belief = model.prior(0);
      belief.pull = {belief.pull.value + drawn(random, -0.3, 0.3), drawn(random, 0.0, 0.2)};
      belief.sinkage.value *= drawn(random, 0.5, 4.0);
      TravelState before = model.state(0, belief, 0.0);
      for (double gradient = 0.0; gradient < 0.6; gradient += drawn(random, 0.0, 0.02)) {
        const TravelState now = model.state(0, belief, gradient);
        ASSERT_GE(model.cost_J_per_m(now), model.cost_J_per_m(before))
            << trial << ' ' << k << ' ' << gradient;
        ASSERT_GE(now.risk_per_m, before.risk_per_m) << trial << ' ' << k << ' ' << gradient;
        compared += now.refusal == Refusal::None;
        before = now;
      }
    }
  }
  EXPECT_GT(compared, 2000);
}

}  // namespace expected_travel_test
}  // namespace talus::costmap
