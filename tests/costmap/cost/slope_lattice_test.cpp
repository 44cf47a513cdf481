#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <site_fixture.hpp>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::costmap {
namespace slope_lattice_test {

GroundBelief certain(const GroundModel& model) {
  GroundBelief belief = model.prior(0);
  belief.pull.std = 0.0;
  return belief;
}

TravelCost costOf(const GroundModel& model, const GroundBelief& belief) {
  return {model.limits(), std::vector<GroundCost>{model.ground(0, belief)}};
}

// A plane that rises by `along` in the heading east and by `across` to the left of the heading.
CellCode plane(double along, double across) {
  return CellCode({.dz_dx = along, .dz_dy = across, .curve = 0});
}

// Strength that a slope requires whether the later axles roll in ruts or not.
double leastOf(const terramech::SlopeEquilibrium& exact, const terramech::Gradient& gradient) {
  return std::max(exact.leastStrength(gradient), exact.withoutRuts().leastStrength(gradient));
}

bool holdsBoth(const terramech::SlopeEquilibrium& exact, const terramech::Gradient& gradient) {
  return exact.at(gradient).holds() && exact.withoutRuts().at(gradient).holds();
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

// Closed form: with prices_crossing = false the cost on any cross slope equals the cost without cross slope.
TEST(SlopeLattice, AlongOnlyCostDependsOnTheLongitudinalGradientOnly) {
  GroundModel::Parts parts = modelOf(testSand()).parts();
  const GroundModel priced(parts);
  parts.prices_crossing = false;
  const GroundModel along_only(parts);
  const TravelCost cost = costOf(along_only, certain(along_only)), full = costOf(priced, certain(priced));
  for (const double along : {-0.1, 0.0, 0.1})
    for (const double across : {0.05, 0.15, 0.25}) {
      EXPECT_EQ(cost.costPerMetre(plane(along, across), {}), cost.costPerMetre(plane(along, 0.0), {}));
      EXPECT_GT(full.costPerMetre(plane(along, across), {}), cost.costPerMetre(plane(along, across), {}));
    }
  const double beyond = along_only.limits().max_across + 0.02;
  EXPECT_TRUE(std::isinf(cost.costPerMetre(plane(0.0, beyond), {})));
}

// Property: a slope is refused if the equilibrium refuses it by more than one row across and one bin along.
TEST(SlopeLattice, InfeasibleEquilibriaAreNeverAllowed) {
  std::mt19937 random(1);
  int refused = 0, held = 0, given_up = 0;
  for (int soils = 0; soils < 6; ++soils) {
    const terramech::Soil soil = drawn(random);
    const GroundModel model = modelOf(soil);
    const terramech::SlopeEquilibrium exact(soil, testRover());
    const TravelCost cost = costOf(model, certain(model));
    for (double along = -0.3; along <= 0.3; along += 0.021)
      for (double across = 0.013; across <= 0.36; across += 0.017) {
        const bool allowed = std::isfinite(cost.costPerMetre(plane(along, across), {}));
        const double inward = along > 0.0 ? -1.0 / 512 : 1.0 / 512;
        const bool holds = holdsBoth(exact, {along, across});
        if (!holds && !holdsBoth(exact, {along + 2 * inward, across})) {
          EXPECT_FALSE(allowed) << soils << ' ' << along << ' ' << across;
          ++refused;
        }
        // Property: a slope is allowed if a slope steeper by one row and one bin has an equilibrium, unless
        // limits other than the soil's apply first.
        if (std::abs(along) < 0.3 && holdsBoth(exact, {along - 1.5 * inward, across + 2.0 / 64}) &&
            holdsBoth(exact, {along + 0.02, across + 2.0 / 64}) &&
            holdsBoth(exact, {along - 0.02, across + 2.0 / 64})) {
          ++held;
          given_up += !allowed;
        }
      }
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(held, 300);
  EXPECT_LE(given_up, held / 50);
}

// Property: away from failure, cost per metre and slip equal those of the equilibrium at the gradient, also
// in row 0 and for any steering. Tolerance: linear interpolation between nodes and equilibria.
TEST(SlopeLattice, CostAndSlipMatchTheEquilibrium) {
  std::mt19937 random(2);
  std::vector<double> ratios;
  for (const auto steering :
       {terramech::Steering::AllWheel, terramech::Steering::Skid, terramech::Steering::Ackermann})
    for (int soils = 0; soils < 2; ++soils) {
      const terramech::Soil soil = drawn(random);
      terramech::Rover rover = testRover();
      rover.steering = steering;
      const GroundModel model(
          {.rover = rover, .classes = {{.number = 0, .soil = soil}}, .policy = {.allow_dangerous = true}});
      const terramech::SlopeEquilibrium exact(soil, rover);
      const TravelCost cost = costOf(model, certain(model));
      for (double along = -0.2; along <= 0.2; along += 0.023)
        for (double across = 0.0; across <= 0.3; across += 0.02) {
          const CellCode cell = plane(along, across);
          const TravelState state = cost.detail(cell, {});
          const auto want = exact.at({cell.dzDx(), cell.dzDy()});
          if (!want.holds() || leastOf(exact, {cell.dzDx(), cell.dzDy()}) > 0.93) continue;
          ASSERT_EQ(state.refusal, Refusal::None) << soils << ' ' << along << ' ' << across;
          const double metre_J = want.energy_J_per_m * std::hypot(1.0, along);
          ratios.push_back(static_cast<double>(state.energy_J_per_m) / metre_J);
          EXPECT_NEAR(static_cast<double>(state.slip), want.slip, 0.02) << along << ' ' << across;
        }
    }
  ASSERT_GT(ratios.size(), 500u);
  std::ranges::sort(ratios);
  EXPECT_GT(ratios.front(), 0.93);
  EXPECT_NEAR(ratios[ratios.size() / 2], 1.0, 0.01);
  EXPECT_LT(ratios.back(), 1.10);
}

// Property: between headings one degree apart, the cost on a plane changes like the energy of the
// equilibrium, without steps.
TEST(SlopeLattice, CostIsSmoothInHeading) {
  const GroundModel model = modelOf(testSand());
  const terramech::SlopeEquilibrium exact(testSand(), testRover());
  const TravelCost cost = costOf(model, certain(model));
  int compared = 0;
  for (double steepness = 0.04; steepness < 0.34; steepness += 0.03) {
    const CellCode cell = plane(steepness, 0.0);
    double before_J = 0.0, exact_J = 0.0;
    for (int degree = 0; degree <= 180; ++degree) {
      const double heading = degree * std::numbers::pi / 180.0;
      const double along = cell.dzDx() * std::cos(heading);
      const double now_J =
          static_cast<double>(cost.costPerMetre(cell, {std::cos(heading), std::sin(heading)}));
      const auto state = exact.at({along, cell.dzDx() * std::sin(heading)});
      const bool away = state.holds() && leastOf(exact, {along, cell.dzDx() * std::sin(heading)}) < 0.93;
      const double metre_J = away ? state.energy_J_per_m * std::hypot(1.0, along) : 0.0;
      if (away && exact_J > 0.0) {
        ++compared;
        EXPECT_NEAR(now_J / before_J, metre_J / exact_J, 0.015) << steepness << ' ' << degree;
      }
      before_J = now_J;
      exact_J = metre_J;
    }
  }
  EXPECT_GT(compared, 800);
}

// A rover with base and track 0.9 m and a centre of mass 1.2 m high tips at atan(0.45 / 1.2) = 20.6 degrees,
// on ground whose strength allows far steeper slopes.
TEST(SlopeLattice, TippingSlopesAreInfeasibleAndGentleOnesAllowed) {
  terramech::Soil clay = testSand();
  clay.cohesion_Pa = 20000.0;
  for (const auto steering :
       {terramech::Steering::AllWheel, terramech::Steering::Skid, terramech::Steering::Ackermann}) {
    terramech::Rover tall = testRover();
    tall.steering = steering;
    tall.wheelbase_m = tall.track_m = 0.9;
    tall.centre_of_mass_height_m = 1.2;
    tall.max_pitch_rad = tall.max_roll_rad = 0.6;
    tall.max_torque_Nm = 200.0;
    const GroundModel model({.rover = tall, .classes = {{.number = 0, .soil = clay}}});
    const terramech::SlopeEquilibrium exact(clay, tall);
    const TravelCost cost = costOf(model, certain(model));
    const double tips = 0.45 / 1.2;
    int tipped = 0;
    for (int degree = 0; degree < 360; degree += 5) {
      const double heading = degree * std::numbers::pi / 180.0;
      const Direction towards{std::cos(heading), std::sin(heading)};
      const CellCode steep = plane(tips + 0.02, 0.0);
      if (exact.at({steep.dzDx() * towards.x, -steep.dzDx() * towards.y}).failure ==
          terramech::SlopeFailure::Tips) {
        ++tipped;
        EXPECT_EQ(cost.detail(steep, towards).refusal, Refusal::Tips) << degree;
      }
      for (const double gentle : {0.02, 0.2, 0.34})
        EXPECT_EQ(cost.detail(plane(gentle, 0.0), towards).refusal, Refusal::None) << gentle << ' ' << degree;
    }
    EXPECT_GT(tipped, 12);
    EXPECT_NEAR(cost.detail(plane(0.3, 0.0), {}).stability_margin_rad, std::atan(tips) - std::atan(0.3),
                0.002);
  }
}

// Property: on an allowed slope the sinkage of the deepest wheel, solved again for its load on the slope, is
// less than the clearance. Tolerance 0.04 of the clearance: table of wheel forces and one bin of gradient.
// The rover is near tipping, so that its lower wheels carry far more than their share.
TEST(SlopeLattice, AllowedSlopesLimitSinkageOfTheDeepestWheelToTheClearance) {
  terramech::Rover tall = testRover();
  tall.wheelbase_m = 0.8;
  tall.centre_of_mass_height_m = 1.6;
  tall.max_pitch_rad = tall.max_roll_rad = 0.4;
  tall.max_torque_Nm = 200.0;
  const terramech::Soil sand = testSand();
  const double even_m = terramech::SlopeEquilibrium(sand, tall).at({}).sinkage_m;
  tall.clearance_m = 1.6 * even_m;
  const GroundModel model(
      {.rover = tall, .classes = {{.number = 0, .soil = sand}}, .policy = {.allow_dangerous = true}});
  const terramech::SlopeEquilibrium exact(sand, tall);
  const TravelCost cost = costOf(model, certain(model));
  int allowed = 0, sunk = 0;
  for (double along = -0.25; along <= 0.25; along += 0.0125)
    for (double across = 0.0; across <= 0.2; across += 0.025) {
      const auto detail = cost.detail(plane(along, across), {});
      sunk += detail.refusal == Refusal::Sinkage;
      if (detail.refusal != Refusal::None) continue;
      ++allowed;
      const terramech::SlopeState state = exact.at({along, across});
      for (const terramech::WheelOnSlope& wheel : exact.wheels({along, across}, state)) {
        if (wheel.load_N <= 1.0) continue;
        const terramech::WheelForces anew = terramech::equilibrium(sand, tall.wheel,
                                                                   {.load_N = wheel.load_N,
                                                                    .slip = wheel.slip,
                                                                    .slip_angle_rad = wheel.slip_angle_rad,
                                                                    .gravity_m_s2 = tall.gravity_m_s2});
        EXPECT_LT(anew.sinkage_m, 1.04 * tall.clearance_m) << along << ' ' << across;
      }
    }
  EXPECT_GT(allowed, 30);
  EXPECT_GT(sunk, 30);
}

// Property: cost, risk and refusal never decrease as the cross slope grows, and are equal for both
// directions of travel.
TEST(SlopeLattice, CostIsMonotoneInSlopeLattice) {
  std::mt19937 random(3);
  for (int soils = 0; soils < 4; ++soils) {
    const GroundModel model = modelOf(drawn(random));
    const TravelCost cost = costOf(model, model.prior(0));
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

TEST(SlopeLattice, SideForceFailureIsReported) {
  terramech::Soil loose = testSand();
  loose.cohesion_Pa = 0.0;
  loose.friction_angle_rad = 0.45;
  const GroundModel model = modelOf(loose);
  const TravelCost cost = costOf(model, certain(model));
  const double steep = model.limits().max_across - 0.01;
  ASSERT_FALSE(terramech::SlopeEquilibrium(loose, testRover()).at({-0.05, steep}).holds());
  EXPECT_EQ(cost.detail(plane(-0.05, steep), {}).refusal, Refusal::SideForce);
  EXPECT_TRUE(std::isinf(cost.costPerMetre(plane(-0.05, steep), {})));
  // A slope that is refused without a cross slope keeps its reason with one.
  EXPECT_EQ(cost.detail(plane(0.3, 0.1), {}).refusal, Refusal::Pull);
}

TEST(SlopeLattice, CostOfTwoGroundsIsAtLeastThatOfTheHarder) {
  const auto model = testGround();
  const GroundBelief belief = model->prior(0);
  const TravelCost cost(model->limits(),
                        std::vector<GroundCost>{model->ground(0, belief), model->ground(1, belief),
                                                model->ground(0, belief, 1)});
  for (double along = -0.3; along <= 0.3; along += 0.02)
    for (double across = 0.0; across <= 0.3; across += 0.02) {
      const auto of = [&](std::uint8_t curve) {
        return cost.costPerMetre(plane(along, across).withCurve(curve), {});
      };
      ASSERT_GE(of(2), std::max(of(0), of(1))) << along << ' ' << across;
    }
}

}  // namespace slope_lattice_test
}  // namespace talus::costmap
