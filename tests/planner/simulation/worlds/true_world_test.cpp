#include <cmath>
#include <utility>
#include <vector>

#include <site_fixture.hpp>

#include <talus/planner/simulation/worlds/true_world.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {
namespace true_world_test {

using costmap::testDust;
using costmap::testRover;
using costmap::testSand;

maps::Raster<std::uint8_t> oneClass() {
  return maps::Raster<std::uint8_t>({.width = 60, .height = 40, .resolution_m = 1.0, .south_west = {}}, 0);
}

// Sand, with dust east of x = 30.
TrueWorld dustInTheEast() {
  return {
      {.classes = {testSand()}, .patches = {{{1030.0, 20.0}, 1000.0, testDust()}}}, testRover(), oneClass()};
}

TEST(TrueWorld, WheelPullBalancesTheSlope) {
  const TrueWorld world = dustInTheEast();
  const std::vector<std::pair<double, double>> cases{
      {-0.1, 10.0}, {0.0, 10.0}, {0.1, 10.0}, {-0.1, 29.8}, {-0.05, 29.8}};
  for (const auto& [gradient, x] : cases) {
    const auto step = world.drive({.place = {x, 20.0}, .heading = {1.0, 0.0}, .gradient = gradient});
    ASSERT_FALSE(step.stuck) << gradient << ' ' << x;
    double pull_N = 0.0, load_N = 0.0;
    for (const auto& wheel : step.wheels) {
      pull_N += wheel.forces.pull * wheel.load_N;
      load_N += wheel.load_N;
    }
    EXPECT_NEAR(pull_N / load_N, gradient,
                2e-3);  // Property: equilibrium, to the table's interpolation error
  }
}

TEST(TrueWorld, FrontAxleEntersThePatchFirst) {
  const TrueWorld world = dustInTheEast();
  const auto before = world.drive({.place = {29.0, 20.0}, .heading = {1.0, 0.0}});
  const auto half = world.drive({.place = {29.8, 20.0}, .heading = {1.0, 0.0}});
  ASSERT_EQ(half.wheels.size(), 4U);
  EXPECT_GT(half.slip, before.slip);
  EXPECT_GT(half.wheels[0].forces.sinkage, 2.0 * half.wheels[2].forces.sinkage);
  EXPECT_LT(half.wheels[0].forces.pull, 0.0);
  EXPECT_GT(half.wheels[2].forces.pull, 0.0);
}

TEST(TrueWorld, RoverWithAllWheelsInTheTrapIsStuck) {
  EXPECT_TRUE(dustInTheEast().drive({.place = {35.0, 20.0}, .heading = {1.0, 0.0}}).stuck);
}

TEST(TrueWorld, RoverAtThePatchEdgeCanReverseInItsRuts) {
  const TrueWorld world = dustInTheEast();
  Ruts ruts(testRover().wheel.width_m);
  for (double x = 28.0; x < 29.81; x += 0.1) {
    for (const auto& wheel : world.drive({.place = {x, 20.0}, .heading = {1.0, 0.0}, .ruts = &ruts}).wheels)
      ruts.press(wheel.place);
    ruts.moved(0.1);
  }
  ruts.turnBack();
  const auto back =
      world.drive({.place = {29.8, 20.0}, .heading = {-1.0, 0.0}, .dug_m = 0.003, .ruts = &ruts});
  EXPECT_FALSE(back.stuck);
  for (const auto& wheel : back.wheels) EXPECT_GT(wheel.passes, 0);
  // Property: digging increases the slip.
  EXPECT_GT(back.slip, world.drive({.place = {29.8, 20.0}, .heading = {-1.0, 0.0}, .ruts = &ruts}).slip);
}

TEST(TrueWorld, SecondPassPullsMoreThanTheFirst) {
  const TrueWorld world = dustInTheEast();
  Ruts ruts(testRover().wheel.width_m);
  for (double x = 8.0; x < 10.0; x += 0.1) {
    for (const auto& wheel : world.drive({.place = {x, 20.0}, .heading = {1.0, 0.0}, .ruts = &ruts}).wheels)
      ruts.press(wheel.place);
    ruts.moved(0.1);
  }
  const auto step = world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .ruts = &ruts});
  EXPECT_EQ(step.wheels[0].passes, 0);
  EXPECT_EQ(step.wheels[2].passes, 1);
  EXPECT_GT(step.wheels[2].forces.pull, step.wheels[0].forces.pull);
}

// Closed form: SlopeEquilibrium on one soil, with independent tables, solver and yaw balance.
TEST(TrueWorld, CrossSlopeStateMatchesTheEquilibrium) {
  terramech::Rover crab = testRover();
  crab.steering = terramech::Steering::AllWheel;
  const TrueWorld world({.classes = {testSand()}, .patches = {}}, crab, oneClass());
  const terramech::SlopeEquilibrium plane(testSand(), crab, {.ruts = false});
  int held = 0;
  for (double along = -0.2; along < 0.21; along += 0.1)
    for (double across = -0.5; across < 0.51; across += 0.1) {
      const auto step =
          world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = along, .across = across});
      const auto want = plane.at({along, across});
      if (!want.holds() || step.slides) {
        EXPECT_TRUE(step.slides || want.slip_angle_rad > 0.7 || want.slip > 0.75) << along << ' ' << across;
        continue;
      }
      ++held;
      EXPECT_NEAR(step.slip, want.slip, 0.03) << along << ' ' << across;
      EXPECT_NEAR(step.slip_angle_rad, want.slip_angle_rad, 0.05) << along << ' ' << across;
      EXPECT_NEAR(step.energy_J_per_m / want.energy_J_per_m, 1.0, 0.05)
          << along << ' ' << across << ' ' << step.slip << ' ' << want.slip << ' ' << step.slip_angle_rad
          << ' ' << want.slip_angle_rad << ' ' << want.slip_difference;
    }
  EXPECT_GT(held, 30);
}

TEST(TrueWorld, CrossSlopeStateIsMirrorSymmetric) {
  const TrueWorld world({.classes = {testSand()}, .patches = {}}, testRover(), oneClass());
  for (const double across : {0.05, 0.15, 0.25}) {
    const auto left =
        world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = 0.05, .across = across});
    const auto right =
        world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = 0.05, .across = -across});
    EXPECT_LT(left.slip_angle_rad, 0.0);  // the wheels point uphill of the direction of travel
    EXPECT_NEAR(left.slip_angle_rad, -right.slip_angle_rad, 1e-12);
    EXPECT_NEAR(left.energy_J_per_m, right.energy_J_per_m, 1e-9);
    EXPECT_NEAR(left.wheels[0].load_N, right.wheels[1].load_N, 1e-9);
    EXPECT_LT(left.wheels[0].load_N, left.wheels[1].load_N);
  }
}

TEST(TrueWorld, RoverSlidesIfNoEquilibriumExists) {
  terramech::Soil slippery = testSand();
  slippery.cohesion_Pa = 100.0;
  slippery.friction_angle_rad = 0.45;
  const TrueWorld world({.classes = {slippery}, .patches = {}}, testRover(), oneClass());
  const auto across =
      world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = -0.1, .across = 0.6});
  EXPECT_TRUE(across.slides && across.stuck);
  const auto down = world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = -1.2});
  EXPECT_TRUE(down.slides && down.stuck);  // too steep for locked wheels
}

TEST(TrueWorld, SoilsAreListedOnceAndPatchesSelectTheirSoil) {
  terramech::Soil mud = testDust();
  mud.cohesion_Pa = 0.0;
  const TrueWorld world({.classes = {testSand()},
                         .patches = {{{10.0, 10.0}, 2.0, testDust()},
                                     {{20.0, 10.0}, 2.0, mud},
                                     {{30.0, 10.0}, 2.0, testDust()}}},
                        testRover(), oneClass());
  EXPECT_EQ(world.soils().size(), 3U);
  EXPECT_EQ(world.soilAt({10.0, 10.0}), 1U);
  EXPECT_EQ(world.soilAt({20.0, 10.0}), 2U);
  EXPECT_EQ(world.soilAt({30.0, 10.0}), 1U);
  EXPECT_EQ(world.soilAt({30.0, 13.0}), 0U);
  EXPECT_EQ(world.soilAt({30.0, 13.0}, 1.5), 1U);
}

TEST(TrueWorld, EnergyIsWorkWithSlipPlusHotelEnergy) {
  const terramech::Rover rover = testRover();
  const TrueWorld world = dustInTheEast();
  const auto step = world.drive({.place = {10.0, 20.0}, .heading = {1.0, 0.0}, .gradient = 0.05});
  const double left = 1.0 - step.slip;
  // Closed form: energy per metre sum T / (r (1 - i)) + P / (v0 (1 - i)), hotel power P, rim speed v0
  EXPECT_NEAR(
      step.energy_J_per_m,
      step.torque_Nm / (rover.wheel.radius_m * left) + rover.hotel_power_W / (rover.max_speed_mps * left),
      1e-9);
}

}  // namespace true_world_test
}  // namespace talus::planner
