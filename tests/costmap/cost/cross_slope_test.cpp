#include <cmath>
#include <numbers>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {
namespace cross_slope_test {

GroundBelief certain(const GroundModel& model) {
  GroundBelief belief = model.prior(0);
  belief.pull.std = 0.0;
  return belief;
}

DriveCost costOf(const GroundModel& model, const GroundBelief& belief) {
  return {model.limits(), std::vector<DriveGround>{model.ground(0, belief)}};
}

// A plane that rises by `along` in the heading east and by `across` to its left.
CellCode plane(double along, double across) {
  return CellCode({.dz_dx = along, .dz_dy = across, .curve = 0});
}

terramech::Soil drawn(std::mt19937& random) {
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  terramech::Soil soil = testSand();
  soil.cohesion_Pa = between(0.0, 2000.0);
  soil.friction_angle_rad = between(24.0, 42.0) * std::numbers::pi / 180.0;
  soil.shear_modulus_m = between(0.005, 0.03);
  soil.sinkage_exponent = between(0.8, 1.2);
  return soil;
}

GroundModel modelOf(const terramech::Soil& soil) {
  return GroundModel(
      {.rover = testRover(), .classes = {{.number = 0, .soil = soil}}, .policy = {.allow_dangerous = true}});
}

// Closed form: a planner that knows slopes along the heading only pays on every slope across what it pays on none.
TEST(CrossSlope, AlongOnlyPricesAPlaneByItsGradientAlong) {
  GroundModel::Parts parts = modelOf(testSand()).parts();
  const GroundModel priced(parts);
  parts.prices_crossing = false;
  const GroundModel along_only(parts);
  const DriveCost cost = costOf(along_only, certain(along_only)), full = costOf(priced, certain(priced));
  for (const double along : {-0.1, 0.0, 0.1})
    for (const double across : {0.05, 0.15, 0.25}) {
      EXPECT_EQ(cost.costPerMetre(plane(along, across), {}), cost.costPerMetre(plane(along, 0.0), {}));
      EXPECT_GT(full.costPerMetre(plane(along, across), {}), cost.costPerMetre(plane(along, across), {}));
    }
  const double beyond = along_only.limits().max_across + 0.02;
  EXPECT_TRUE(std::isinf(cost.costPerMetre(plane(0.0, beyond), {})));
}

// Property: what the equilibrium of the rover refuses by more than a row across and a bin along is not allowed.
TEST(CrossSlope, AllowsNothingThatTheEquilibriumRefuses) {
  std::mt19937 random(1);
  int refused = 0, held = 0, given_up = 0;
  for (int soils = 0; soils < 6; ++soils) {
    const terramech::Soil soil = drawn(random);
    const GroundModel model = modelOf(soil);
    const terramech::SlopeEquilibrium exact(soil, testRover());
    const DriveCost cost = costOf(model, certain(model));
    for (double along = -0.3; along <= 0.3; along += 0.021)
      for (double across = 0.013; across <= 0.36; across += 0.017) {
        const bool allowed = std::isfinite(cost.costPerMetre(plane(along, across), {}));
        const double inward = along > 0.0 ? -1.0 / 512 : 1.0 / 512;
        const bool holds = exact.at({along, across}).holds();
        if (!holds && !exact.at({along + 2 * inward, across}).holds()) {
          EXPECT_FALSE(allowed) << soils << ' ' << along << ' ' << across;
          ++refused;
        }
        // And what holds with a row and a bin to spare is given up nowhere, but where limits other than the
        // soil's come first.
        if (std::abs(along) < 0.3 && exact.at({along - 1.5 * inward, across + 2.0 / 64}).holds() &&
            exact.at({along + 0.02, across + 2.0 / 64}).holds() &&
            exact.at({along - 0.02, across + 2.0 / 64}).holds()) {
          ++held;
          given_up += !allowed;
        }
      }
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(held, 300);
  EXPECT_LE(given_up, held / 50);
}

// Property: a metre costs no less, against straight driving, than in the equilibrium. Tolerance: straight driving has
// even loads, the equilibrium moves them.
TEST(CrossSlope, CostsWhatTheEquilibriumAdds) {
  std::mt19937 random(2);
  int seen = 0;
  for (int soils = 0; soils < 4; ++soils) {
    const terramech::Soil soil = drawn(random);
    const GroundModel model = modelOf(soil);
    const terramech::SlopeEquilibrium exact(soil, testRover());
    const DriveCost cost = costOf(model, certain(model));
    for (double along = -0.2; along <= 0.2; along += 0.023)
      for (double across = 0.013; across <= 0.3; across += 0.02) {
        const DriveState crossing = cost.detail(plane(along, across), {});
        const DriveState straight = cost.detail(plane(along, 0.0), {});
        const auto exact_crossing = exact.at({along, across}), exact_straight = exact.at({along, 0.0});
        if (crossing.refusal != Refusal::None || !exact_crossing.holds() || !exact_straight.holds()) continue;
        ++seen;
        const double ratio = exact_crossing.energy_J_per_m / exact_straight.energy_J_per_m;
        EXPECT_GE(static_cast<double>(crossing.energy_J_per_m / straight.energy_J_per_m),
                  0.96 * std::min(ratio, 3.0))
            << soils << ' ' << along << ' ' << across;
      }
  }
  EXPECT_GT(seen, 200);
}

// Property: cost, risk and refusal never fall as the slope across grows, nor when the rover crosses it the other
// way round.
TEST(CrossSlope, SteeperAcrossIsNeverCheaper) {
  std::mt19937 random(3);
  for (int soils = 0; soils < 4; ++soils) {
    const GroundModel model = modelOf(drawn(random));
    const DriveCost cost = costOf(model, model.prior(0));
    for (double along = -0.35; along <= 0.35; along += 0.01) {
      float before = 0.0F;
      for (double across = 0.0; across < 0.36; across += 0.005) {
        const float now = cost.costPerMetre(plane(along, across), {});
        ASSERT_GE(now, before) << along << ' ' << across;
        ASSERT_EQ(now, cost.costPerMetre(plane(along, -across), {}));
        before = now;
      }
    }
  }
}

// Property: weaker or less sure ground is never cheaper in any heading, and never allowed where stronger ground
// is refused.
TEST(CrossSlope, WeakerGroundIsNeverCheaper) {
  std::mt19937 random(4);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int soils = 0; soils < 12; ++soils) {
    const GroundModel model = modelOf(drawn(random));
    GroundBelief strong = model.prior(0);
    strong.pull = {strong.pull.value + between(-0.1, 0.1), between(0.0, 0.1)};
    GroundBelief weak = strong;
    weak.pull.value -= between(0.0, 0.05);
    weak.pull.std += between(0.0, 0.03);
    const DriveCost stronger = costOf(model, strong), weaker = costOf(model, weak);
    for (double steepness = 0.0; steepness < 0.36; steepness += 0.02)
      for (int k = 0; k < 36; ++k) {
        const double heading = k * std::numbers::pi / 18;
        const CellCode cell = plane(steepness, 0.0);
        const Direction towards{std::cos(heading), std::sin(heading)};
        ASSERT_GE(weaker.costPerMetre(cell, towards), stronger.costPerMetre(cell, towards))
            << soils << ' ' << steepness << ' ' << k;
      }
  }
}

TEST(CrossSlope, NamesTheSideForce) {
  terramech::Soil loose = testSand();
  loose.cohesion_Pa = 0.0;
  loose.friction_angle_rad = 0.45;
  const GroundModel model = modelOf(loose);
  const DriveCost cost = costOf(model, certain(model));
  const double steep = model.limits().max_across - 0.01;
  ASSERT_FALSE(terramech::SlopeEquilibrium(loose, testRover()).at({-0.05, steep}).holds());
  EXPECT_EQ(cost.detail(plane(-0.05, steep), {}).refusal, Refusal::SideForce);
  EXPECT_TRUE(std::isinf(cost.costPerMetre(plane(-0.05, steep), {})));
  // What is refused without anything across keeps its reason.
  EXPECT_EQ(cost.detail(plane(0.3, 0.1), {}).refusal, Refusal::Pull);
}

TEST(CrossSlope, OfTwoGroundsTheHarderCounts) {
  const auto model = testGround();
  const GroundBelief belief = model->prior(0);
  const DriveCost cost(model->limits(),
                       std::vector<DriveGround>{model->ground(0, 0, belief), model->ground(1, 1, belief),
                                                model->ground(0, 1, belief)});
  for (double along = -0.3; along <= 0.3; along += 0.02)
    for (double across = 0.0; across <= 0.3; across += 0.02) {
      const auto of = [&](std::uint8_t curve) {
        return cost.costPerMetre(plane(along, across).withCurve(curve), {});
      };
      ASSERT_GE(of(2), std::max(of(0), of(1))) << along << ' ' << across;
    }
}

}  // namespace cross_slope_test
}  // namespace talus::costmap
