#include <cmath>
#include <utility>
#include <vector>

#include <site_fixture.hpp>

#include <talus/planner/simulation/worlds/true_world.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {
namespace true_world_test {

TEST(Ruts, WheelIsNotInItsOwnRut) {
  Ruts ruts(0.1);
  for (double x = 0.05; x < 1.0; x += 0.02) {
    EXPECT_EQ(ruts.passes({x, 0.0}), 0) << x;
    ruts.press({x, 0.0});
    ruts.moved(0.02);
  }
  EXPECT_EQ(ruts.passes({0.05, 0.0}), 1);
  EXPECT_EQ(ruts.passes({0.05, 0.3}), 0);
}

TEST(Ruts, PassesAreCountedPerWheel) {
  Ruts ruts(0.1);
  for (int wheel = 0; wheel < 3; ++wheel) {
    EXPECT_EQ(ruts.passes({0.05, 0.05}), wheel);
    ruts.press({0.05, 0.05});
    EXPECT_EQ(ruts.passes({0.05, 0.05}), wheel) << "it stands there now";
    ruts.moved(0.5);
  }
}

TEST(Ruts, ReversingRoverIsInItsRut) {
  Ruts ruts(0.1);
  ruts.press({0.05, 0.05});
  EXPECT_EQ(ruts.passes({0.05, 0.05}), 0);
  ruts.turnBack();
  EXPECT_EQ(ruts.passes({0.05, 0.05}), 1);
}

TEST(Ruts, NegativeCoordinatesAreSupported) {
  Ruts ruts(0.1);
  ruts.press({-0.05, -123.45});
  ruts.turnBack();
  EXPECT_EQ(ruts.passes({-0.05, -123.45}), 1);
  EXPECT_EQ(ruts.passes({0.05, -123.45}), 0);
}

using costmap::testRover;
using costmap::testSand;

TEST(SimulatedWheelTable, NodesMatchTheForwardModel) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (std::size_t layer = 0; layer < SimulatedWheelTable::kLoads; ++layer)
    for (const double slip : {-0.5, 0.0, 0.3, 0.5}) {
      // Closed form: the forward model at the table's nodes, at every 0.025 of slip
      const double load = SimulatedWheelTable::load(layer), load_N = load * terramech::wheelLoad_N(rover);
      const auto wheel = terramech::equilibrium(testSand(), rover.wheel, {.load_N = load_N, .slip = slip});
      const SimulatedWheelTable::Row row = table.at(slip, load);
      EXPECT_NEAR(row.pull, wheel.drawbar_pull_N / load_N, 1e-7);  // stated accuracy of the batch
      EXPECT_NEAR(row.sinkage, wheel.sinkage_m / rover.wheel.radius_m, 1e-7);
      EXPECT_NEAR(row.torque, wheel.torque_Nm / (load_N * rover.wheel.radius_m), 1e-7);
      EXPECT_EQ(row.hold, 0.0);
    }
  // Property: between two nodes a value lies between theirs, and beyond the last node it is constant.
  EXPECT_GT(table.at(0.3, 1.05).sinkage, table.at(0.3, 1.0).sinkage);
  EXPECT_LT(table.at(0.3, 1.05).sinkage, table.at(0.3, 1.15).sinkage);
  EXPECT_NEAR(table.at(0.3, 2.5).sinkage, table.at(0.3, 1.9).sinkage, 1e-12);
}

// Property: at slip angles the nodes equal the forward model; the side force is a magnitude.
TEST(SimulatedWheelTable, NodesMatchTheForwardModelAtSlipAngles) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (std::size_t sheet = 1; sheet < SimulatedWheelTable::kAngles; ++sheet)
    for (const double slip : {-0.5, 0.0, 0.3, 0.5}) {
      const double load_N = terramech::wheelLoad_N(rover), angle = SimulatedWheelTable::angle_rad(sheet);
      const auto wheel = terramech::equilibrium(
          testSand(), rover.wheel,
          {.load_N = load_N, .slip = slip, .slip_angle_rad = angle, .gravity_m_s2 = rover.gravity_m_s2});
      const SimulatedWheelTable::Row row = table.at(slip, 1.0, -angle);
      EXPECT_NEAR(row.pull, wheel.drawbar_pull_N / load_N, 1e-6);
      EXPECT_NEAR(row.hold, -wheel.side_force_N / load_N, 1e-6);
      EXPECT_GT(row.hold, 0.0);
      EXPECT_EQ(row.hold, table.at(slip, 1.0, angle).hold);
    }
}

// Property: between nodes the table equals the forward model to 1 % of the load, away from slip 0.
TEST(SimulatedWheelTable, InterpolationMatchesTheForwardModelWithinOnePercent) {
  const terramech::Rover rover = testRover();
  const SimulatedWheelTable table(testSand(), rover);
  for (double slip = 0.06; slip < 0.9; slip += 0.0713)
    for (double load = 0.3; load < 1.9; load += 0.083) {
      const double load_N = load * terramech::wheelLoad_N(rover);
      const auto wheel = terramech::equilibrium(testSand(), rover.wheel, {.load_N = load_N, .slip = slip});
      EXPECT_NEAR(table.at(slip, load).pull, wheel.drawbar_pull_N / load_N, 0.01) << slip << " " << load;
    }
}

// A soil without strength or stiffness carries no load: no pull at any slip.
TEST(SimulatedWheelTable, SoilWithoutBearingCapacityYieldsNoPull) {
  terramech::Soil mud = testSand();
  mud.cohesive_modulus = 0.0;
  mud.frictional_modulus = 10.0;
  const SimulatedWheelTable table(mud, testRover());
  for (const double slip : {0.1, 0.5, 0.9}) EXPECT_LE(table.at(slip, 1.0).pull, 0.0) << slip;
}

using costmap::testDust;

maps::Raster<std::uint8_t> oneClass() {
  return maps::Raster<std::uint8_t>({.width = 60, .height = 40, .resolution_m = 1.0, .south_west = {}}, 0);
}

// Sand, with dust east of x = 30.
TrueWorld dustInTheEast() {
  return {
      {.classes = {testSand()}, .patches = {{{1030.0, 20.0}, 1000.0, testDust()}}}, testRover(), oneClass()};
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
