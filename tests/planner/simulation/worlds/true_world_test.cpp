#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <refused.hpp>
#include <site_fixture.hpp>
#include <site_map.hpp>

#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {

namespace true_world_test {

using costmap::testDust;
using costmap::testSand;

std::vector<std::string> plain() {
  return std::vector<std::string>(30, std::string(40, '1'));
}

Truth random(int patches) {
  Truth truth;
  truth.spread = 0.1;
  truth.random_patches = patches;
  truth.patch_radius_m = 2.0;
  truth.patch_soil = testDust();
  return truth;
}

TEST(DrawWorld, PatchesKeepClearOfStartAndGoal) {
  const auto map = costmap::mapOf(plain());
  const auto& classes = map.model().parts().classes;
  std::size_t patches = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const WorldSoils world = drawWorld(random(20), classes, map.grid(),
                                       {.seed = seed, .start = {105.5, 215.5}, .goal = {135.5, 215.5}});
    patches += world.patches.size();
    for (const SoilPatch& p : world.patches) {
      EXPECT_GE(std::hypot(p.centre.x_m - 105.5, p.centre.y_m - 215.5), p.radius_m + 2.0);
      EXPECT_GE(std::hypot(p.centre.x_m - 135.5, p.centre.y_m - 215.5), p.radius_m + 2.0);
      EXPECT_GE(p.radius_m, 1.0);
      EXPECT_LE(p.radius_m, 3.0);
    }
    EXPECT_EQ(world.classes.size(), 2U);
  }
  EXPECT_GT(patches, 600U);
  EXPECT_LT(patches, 1000U);
}

TEST(DrawWorld, SpreadEqualsTheStatedStd) {
  const auto map = costmap::mapOf(plain());
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 2000;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const auto world = drawWorld(random(0), map.model().parts().classes, map.grid(), {.seed = seed});
    const double factor = world.classes[0].cohesion_Pa / testSand().cohesion_Pa;
    sum += factor;
    squares += factor * factor;
  }
  const double mean = sum / kDraws, std = std::sqrt(squares / kDraws - mean * mean);
  EXPECT_NEAR(mean, 1.0, 0.01);  // Property: four standard errors of 2000 draws
  EXPECT_NEAR(std, 0.1, 0.007);
}

// Property: the same seed gives the same world; declared patches and true classes occur in every world.
TEST(DrawWorld, WorldDependsOnTheSeedOnly) {
  const auto map = costmap::mapOf(plain());
  const auto& classes = map.model().parts().classes;
  Truth truth = random(5);
  truth.patches = {{{110.5, 205.5}, 1.5, testDust()}};
  truth.classes = {{1, testDust()}};
  const auto draw = [&](std::uint64_t seed) { return drawWorld(truth, classes, map.grid(), {.seed = seed}); };
  const WorldSoils one = draw(3), same = draw(3), other = draw(4);
  ASSERT_EQ(one.patches.size(), same.patches.size());
  for (std::size_t i = 0; i < one.patches.size(); ++i)
    EXPECT_EQ(one.patches[i].centre, same.patches[i].centre);
  EXPECT_EQ(one.classes[0].cohesion_Pa, same.classes[0].cohesion_Pa);
  EXPECT_NE(one.classes[0].cohesion_Pa, other.classes[0].cohesion_Pa);
  EXPECT_NEAR(one.classes[0].cohesion_Pa, testDust().cohesion_Pa,
              0.6 * testDust().cohesion_Pa);  // six standard deviations
  for (const WorldSoils* world : {&one, &other})
    EXPECT_TRUE(std::ranges::any_of(world->patches, [](const SoilPatch& p) {
      return p.centre == maps::Point{110.5, 205.5} && p.radius_m == 1.5;
    }));
}

// Property: the draw of a class and of the random patches does not depend on other declarations or their
// order.
TEST(DrawWorld, ClassDrawDependsOnItsNumberOnly) {
  const auto map = costmap::mapOf(plain());
  std::vector<costmap::GroundClass> classes = map.model().parts().classes;
  ASSERT_EQ(classes.size(), 2U);
  const WorldSoils world = drawWorld(random(5), classes, map.grid(), {.seed = 3});
  std::ranges::reverse(classes);
  classes.insert(classes.begin(), costmap::GroundClass{.number = 99, .soil = testDust()});
  const WorldSoils more = drawWorld(random(5), classes, map.grid(), {.seed = 3});
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_EQ(more.classes[2 - k].cohesion_Pa, world.classes[k].cohesion_Pa);
    EXPECT_EQ(more.classes[2 - k].friction_angle_rad, world.classes[k].friction_angle_rad);
  }
  ASSERT_EQ(more.patches.size(), world.patches.size());
  for (std::size_t i = 0; i < world.patches.size(); ++i) {
    EXPECT_EQ(more.patches[i].centre, world.patches[i].centre);
    EXPECT_EQ(more.patches[i].soil.cohesion_Pa, world.patches[i].soil.cohesion_Pa);
  }
  EXPECT_NE(world.classes[0].cohesion_Pa / testSand().cohesion_Pa,
            world.classes[1].cohesion_Pa / testDust().cohesion_Pa);
}

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
  const auto plane = terramech::SlopeEquilibrium(testSand(), crab).withoutRuts();
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

namespace simulated_sensors_test {

using costmap::testRover;
using costmap::testSand;

// A step of a four-wheeled rover at slip 0.3 with a sinkage of 0.2 of the wheel radius.
TrueWorld::Step step() {
  TrueWorld::Step made;
  made.slip = 0.3;
  for (int w = 0; w < 4; ++w)
    made.wheels.push_back({.place = {10.0 + w, 20.0}, .load_N = 50.0, .passes = w / 2, .forces = {}});
  for (auto& wheel : made.wheels) wheel.forces = {.pull = 0.1, .torque = 0.4, .sinkage = 0.2};
  return made;
}

WheelMeasurements lookOf(SimulatedSensors& sensors, double time_s = 5.0) {
  return sensors.look(step(), {.time_s = time_s, .heading = {0.0, 1.0}, .gradient = 0.1});
}

SensorOptions exact(SensorFault fault = SensorFault::None) {
  return {.noise = false, .pose_drift = 0.0, .fault = fault, .seed = 3};
}

TEST(SimulatedSensors, WithoutNoiseReadingsEqualTheTruth) {
  SimulatedSensors sensors(exact(), testRover());
  const WheelMeasurements look = lookOf(sensors);
  const double radius_m = testRover().wheel.radius_m;
  ASSERT_EQ(look.wheels.size(), 4U);
  for (std::size_t w = 0; w < 4; ++w) {
    // Closed form: without noise the readings equal the step.
    EXPECT_DOUBLE_EQ(look.wheels[w].slip, 0.3);
    EXPECT_DOUBLE_EQ(look.wheels[w].torque_Nm, 0.4 * 50.0 * radius_m);
    EXPECT_DOUBLE_EQ(look.wheels[w].sinkage_m, 0.2 * radius_m);
    EXPECT_DOUBLE_EQ(look.wheels[w].place.x_m, 10.0 + static_cast<double>(w));
    EXPECT_EQ(look.wheels[w].pass, static_cast<int>(w) / 2 + 1);
  }
}

TEST(SimulatedSensors, NoiseHasTheStatedStd) {
  SensorOptions options = exact();
  options.noise = true;
  SimulatedSensors sensors(options, testRover());
  double squares = 0.0;
  std::size_t missing = 0;
  constexpr int kLooks = 2000;
  for (int k = 0; k < kLooks; ++k) {
    const WheelMeasurements look = lookOf(sensors);
    squares += std::pow(look.wheels[0].slip - 0.3, 2);
    for (const auto& wheel : look.wheels) missing += std::isnan(wheel.torque_Nm) ? 1U : 0U;
  }
  // Property: standard deviations of 0.02 (rover) and 0.005 (wheel); tolerance four standard errors of 2000
  // draws.
  EXPECT_NEAR(std::sqrt(squares / kLooks), std::hypot(0.02, 0.005), 0.0014);
  EXPECT_NEAR(static_cast<double>(missing) / (4.0 * kLooks), 0.02, 0.0063);
}

TEST(SimulatedSensors, PoseErrorGrowsWithDistance) {
  SensorOptions options = exact();
  options.pose_drift = 0.02;
  SimulatedSensors sensors(options, testRover());
  for (int k = 0; k < 100; ++k) sensors.moved(0.5);
  const maps::Point there = sensors.estimatedPlace({7.0, 8.0});
  EXPECT_NEAR(std::hypot(there.x_m - 7.0, there.y_m - 8.0), 1.0, 1e-9);  // Closed form: 2 % of 50 m
}

// Effect of a fault on the faulty wheel and on the others.
TEST(SimulatedSensors, FaultAffectsOneSensorOnly) {
  const double radius_m = testRover().wheel.radius_m;
  for (const SensorFault fault : {SensorFault::SlipBiased, SensorFault::TorqueOffset,
                                  SensorFault::SinkageDatum, SensorFault::Silent, SensorFault::SlipStuck}) {
    SimulatedSensors sensors(exact(fault), testRover());
    const WheelMeasurements look = lookOf(sensors);
    for (std::size_t w = 0; w < 4; ++w) {
      const bool faulty = w == sensors.faultyWheel();
      const auto& read = look.wheels[w];
      EXPECT_EQ(std::isnan(read.slip), faulty && fault == SensorFault::Silent);
      if (faulty && fault == SensorFault::Silent) continue;
      EXPECT_NEAR(read.slip, faulty && fault == SensorFault::SlipBiased ? 0.1 : 0.3, 1e-12);
      EXPECT_NEAR(read.torque_Nm / (50.0 * radius_m),
                  faulty && fault == SensorFault::TorqueOffset ? 0.55 : 0.4, 1e-12);
      EXPECT_NEAR(read.sinkage_m / radius_m, faulty && fault == SensorFault::SinkageDatum ? 0.1 : 0.2, 1e-12);
    }
  }
}

TEST(SimulatedSensors, StuckSlipKeepsItsFirstValue) {
  SensorOptions options = exact(SensorFault::OdometryStuck);
  options.noise = true;
  SimulatedSensors sensors(options, testRover());
  const double first = lookOf(sensors).wheels[0].slip;
  for (int k = 0; k < 5; ++k)
    for (const auto& wheel : lookOf(sensors).wheels) EXPECT_EQ(wheel.slip, first);
}

TEST(TelemetryOf, TelemetryHasOneRowPerWheelWithSlip) {
  SimulatedSensors sensors(exact(SensorFault::Silent), testRover());
  const terramech::Telemetry rows = telemetryOf(lookOf(sensors, 7.5));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows.at("slip"), testing::Each(0.3));
  // Closed form: without noise the second slip 1 - speed_mps/rim_speed_mps is the true one.
  EXPECT_NEAR(1.0 - rows.at("speed_mps")[0] / rows.at("rim_speed_mps")[0], 0.3, 1e-12);
  SensorOptions once = exact(SensorFault::Silent);
  once.second_slip = false;
  SimulatedSensors without(once, testRover());
  EXPECT_TRUE(std::isnan(telemetryOf(lookOf(without, 7.5)).at("speed_mps")[0]));
  EXPECT_THAT(rows.at("time_s"), testing::Each(7.5));
  EXPECT_NEAR(rows.at("slope_rad")[0], std::atan(0.1), 1e-12);
  EXPECT_EQ(rows.findWords("wheel")->size(), 3U);
}

// With a drift of 1 the rover would never estimate itself at its goal, and the simulation would not end.
TEST(SimulatedSensors, PoseDriftOutOfRangeIsRejected) {
  for (const double drift : {-0.1, 0.6, 1.0, std::nan("")})
    EXPECT_REFUSED(SimulatedSensors({.pose_drift = drift}, testRover()), std::invalid_argument,
                   "pose_drift = " + std::to_string(drift) + ", must be 0 to 0.500000");
}

}  // namespace simulated_sensors_test

}  // namespace talus::planner
