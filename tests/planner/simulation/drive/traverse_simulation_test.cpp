#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <site_fixture.hpp>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::planner {

namespace traverse_simulation_test {

constexpr double kRadius_m = 0.1;

// Six wheels; the middle and rear wheels run in ruts.
WheelMeasurements quiet() {
  WheelMeasurements look;
  for (int w = 0; w < 6; ++w) look.wheels.push_back({.slip = 0.1, .sinkage_m = 0.01, .pass = w / 2 + 1});
  return look;
}

const std::vector<WheelExpectation> kExpected(6, {.slip = 0.1, .sinkage_over_radius = 0.1});

TEST(WheelAlarm, ExpectedReadingsRaiseNoAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  for (int k = 0; k < 200; ++k) EXPECT_FALSE(alarm.check(quiet(), kExpected).reason);
}

TEST(WheelAlarm, SingleSlipSensorNeitherTriggersNorSuppressesTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements one = quiet();
  one.wheels[2].slip = 0.9;
  EXPECT_FALSE(alarm.check(one, kExpected).reason);
  WheelMeasurements all = quiet();
  for (auto& wheel : all.wheels) wheel.slip = 0.9;
  all.wheels[4].slip = 0.1;
  all.wheels[5].slip = std::nan("");
  EXPECT_EQ(alarm.check(all, kExpected).reason, "slips");
}

TEST(WheelAlarm, SlipAngleAboveExpectationTriggersTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements look = quiet();
  look.slip_angle_rad = -0.2;
  EXPECT_EQ(alarm.check(look, kExpected).reason, "slides");
  std::vector<WheelExpectation> slope = kExpected;
  for (auto& wheel : slope) wheel.slip_angle_rad = 0.1;
  EXPECT_FALSE(alarm.check(look, slope).reason);
  slope.assign(6, {.slip = 0.1, .sinkage_over_radius = 0.1, .slip_angle_rad = std::nan("")});
  EXPECT_EQ(alarm.check(look, slope).reason, "slides");  // unknown angle: compared with level ground
}

// Property: less braking than expected downhill is no alarm; a sensor stuck at its level-ground value would
// otherwise stop the rover.
TEST(WheelAlarm, LowSlipDownhillIsNoAlarm) {
  const std::vector<WheelExpectation> downhill(6, {.slip = -0.2, .sinkage_over_radius = 0.1});
  WheelAlarm alarm({}, kRadius_m);
  EXPECT_FALSE(alarm.check(quiet(), downhill).reason);
  WheelMeasurements slipping = quiet();
  for (auto& wheel : slipping.wheels) wheel.slip = 0.21;
  EXPECT_EQ(alarm.check(slipping, downhill).reason, "slips");
  EXPECT_FALSE(alarm.check(slipping, kExpected).reason);
}

TEST(WheelAlarm, SinkageOfOneWheelTriggersTheAlarm) {
  WheelAlarm alarm({}, kRadius_m);
  WheelMeasurements look = quiet();
  look.wheels[1].sinkage_m = 0.02;
  const WheelAlarm::AlarmCheck check = alarm.check(look, kExpected);
  EXPECT_EQ(check.reason, "sinks");
  EXPECT_EQ(check.sank, (std::vector<bool>{false, true, false, false, false, false}));
  look.wheels[1].pass = 2;  // a rut of another wheel gives no evidence on fresh ground
  EXPECT_FALSE(alarm.check(look, kExpected).reason);
}

TEST(WheelAlarm, ConstantSinkageOffsetIsRemovedAndAJumpTriggersTheAlarm) {
  for (const double datum_m : {0.007, -0.007}) {
    WheelAlarm alarm({}, kRadius_m);
    WheelMeasurements look = quiet();
    look.wheels[0].sinkage_m += datum_m;
    for (int k = 0; k < 50; ++k) EXPECT_FALSE(alarm.check(look, kExpected).reason) << datum_m;
    look.wheels[0].sinkage_m += 0.009;
    EXPECT_EQ(alarm.check(look, kExpected).reason, "sinks") << datum_m;
  }
}

using costmap::testRover;
using costmap::testSand;

// Level ground of sand with a small standard deviation.
costmap::TraversabilityMap levelMap() {
  costmap::MapLayers layers;
  layers.elevation.elevation_m =
      maps::Raster<float>({.width = 40, .height = 40, .resolution_m = 1.0, .south_west = {}}, 0.0F);
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  for (costmap::GroundClass& ground : parts.classes) ground.mean_std = 0.01;
  return {std::move(layers), std::make_shared<const costmap::GroundModel>(parts), {}};
}

costmap::CellCode slope(double dz_dx, double dz_dy) {
  return costmap::CellCode({.dz_dx = dz_dx, .dz_dy = dz_dy, .curve = 0});
}

// Closed form: the equilibrium on the plane under the rover, not on the map's plane at the place.
TEST(MapExpectation, ExpectationIsThatOfTheSlopeUnderTheRover) {
  const costmap::TraversabilityMap map = levelMap();
  const terramech::SlopeEquilibrium plane(testSand(), testRover());
  for (const double across : {-0.2, 0.0, 0.1, 0.2}) {
    const WheelExpectation said =
        MapExpectation(map, slope(0.0, across)).ofWheel({20.5, 20.5}, {20.0, 20.5}, {1.0, 0.0});
    const auto want = plane.at({0.0, across});
    EXPECT_NEAR(said.slip_angle_rad, std::abs(want.slip_angle_rad), 0.03) << across;
    // Property: the cost grid, and with it the route file, has the sign of telemetry.
    EXPECT_NEAR(map.published()->cost().detail(slope(0.0, across), {1.0, 0.0}).slip_angle_rad,
                want.slip_angle_rad, 0.03)
        << across;
    EXPECT_GE(said.slip, want.slip - 0.02) << across;  // Property: at least the required slip
    EXPECT_GT(said.sinkage_over_radius, 0.0);
  }
}

// Property: refused ground and ground off the map have an expectation as well.
TEST(MapExpectation, RefusedGroundHasTheExpectationOfItsClass) {
  costmap::TraversabilityMap map = levelMap();
  const MapExpectation before(map, slope(0.05, 0.0));
  const auto sound = before.at({20.5, 20.5}, {1.0, 0.0});
  map.refuse({20.5, 20.5}, 2.0);
  map.publish();
  const auto refused = MapExpectation(map, slope(0.05, 0.0)).at({20.5, 20.5}, {1.0, 0.0});
  EXPECT_FLOAT_EQ(refused.slip, sound.slip);
  EXPECT_GT(refused.slip, 0.0F);
  EXPECT_EQ(before.at({-5.0, 0.0}, {1.0, 0.0}).slip, 0.0F);
}

using costmap::testDust;

maps::Grid grid() {
  return {.width = 60, .height = 40, .resolution_m = 1.0, .south_west = {}};
}

// A plane that rises eastwards, classified as sand with a small class standard deviation. With a larger one
// the planner would tack up the slope, because risk grows faster with the gradient than the length does, and
// would not meet a trap on the straight line.
costmap::TraversabilityMap planeMap(double rise) {
  costmap::MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid());
  for (int row = 0; row < grid().height; ++row)
    for (int column = 0; column < grid().width; ++column)
      layers.elevation.elevation_m[{column, row}] = static_cast<float>(rise * column);
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  for (costmap::GroundClass& ground : parts.classes) ground.mean_std = 0.01;
  return {std::move(layers), std::make_shared<const costmap::GroundModel>(parts), {}};
}

struct Site {
  WorldSoils soils;
  double rise = 0.0;
  maps::Point start{5.5, 20.5}, goal{54.5, 20.5};
};

TraverseSimulation over(const Site& site, bool senses, const SensorOptions& sensors = {.pose_drift = 0.0}) {
  const TrueWorld world(site.soils, testRover(), maps::Raster<std::uint8_t>(grid(), 0));
  costmap::TraversabilityMap map = planeMap(site.rise);
  SimulationOptions options;
  options.start = site.start;
  options.goal = site.goal;
  options.senses = senses;
  options.sensors = sensors;
  return simulateTraverse(map, world, options);
}

Site trapped(double rise = 0.0) {
  return {{.classes = {testSand()}, .patches = {{{30.0, 20.5}, 4.0, testDust()}}}, rise};
}

TEST(TraverseSimulation, CorrectlyMappedGroundIsTraversedWithoutAlarm) {
  const TraverseSimulation drive = over({{.classes = {testSand()}, .patches = {}}}, true);
  EXPECT_EQ(drive.outcome, Outcome::Reached);
  EXPECT_EQ(drive.alarms, 0);
  EXPECT_NEAR(drive.length_m, 49.0, 0.5);  // Closed form: straight over flat ground, to the goal
}

TEST(TraverseSimulation, UndeclaredTrapImmobilisesARoverWithoutAlarm) {
  EXPECT_EQ(over(trapped(), false).outcome, Outcome::Immobilised);
}

TEST(TraverseSimulation, RoverWithAlarmReversesAndReplansAroundATrap) {
  for (const double rise : {0.0, 0.03, -0.06}) {
    const TraverseSimulation drive = over(trapped(rise), true);
    EXPECT_EQ(drive.outcome, Outcome::Reached) << rise;
    EXPECT_GE(drive.alarms, 1) << rise;
    EXPECT_GE(drive.replans, drive.alarms) << rise;
    EXPECT_GT(drive.length_m, 50.0) << rise;
    EXPECT_LT(drive.length_m, 85.0) << rise;
  }
}

// Property: drift of the pose causes detours around misplaced evidence, but no immobilisation.
TEST(TraverseSimulation, PoseDriftCausesNoImmobilisation) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const TraverseSimulation drive = over(trapped(), true, {.pose_drift = 0.01, .seed = seed});
    EXPECT_NE(drive.outcome, Outcome::Immobilised) << seed;
    EXPECT_NE(drive.outcome, Outcome::Tipped) << seed;
    EXPECT_GE(drive.alarms, 1) << seed;
  }
}

// A plane that rises to the right of the route, with ground that provides pull but too little side force.
TEST(TraverseSimulation, RoverWithAlarmDoesNotSlideOnACrossSlope) {
  terramech::Soil slippery = testSand();
  slippery.cohesion_Pa = 100.0;
  slippery.friction_angle_rad = 0.45;
  const WorldSoils soils{.classes = {testSand()}, .patches = {{{30.0, 20.5}, 3.0, slippery}}};
  const double rise = 0.25;
  const Site site{soils, rise, {30.5, 2.5}, {30.5, 37.5}};
  EXPECT_EQ(over(site, false).outcome, Outcome::Slid);
  const TraverseSimulation drive = over(site, true);
  EXPECT_NE(drive.outcome, Outcome::Slid);
  EXPECT_NE(drive.outcome, Outcome::Immobilised);
  EXPECT_GE(drive.replans, 1);  // by an alarm, or because the soil is found to be weaker on the way
}

TEST(TraverseSimulation, ImpassableTrapEndsInGivingUp) {
  const Site wall{{.classes = {testSand()}, .patches = {{{1030.0, 20.5}, 1000.0, testDust()}}}, 0.0};
  const TraverseSimulation drive = over(wall, true);
  EXPECT_EQ(drive.outcome, Outcome::GaveUp);
  for (const TrackPoint& at : drive.track)
    EXPECT_LT(at.place.x_m, 30.5);  // at most the front wheels were on it
}

// Weaker ground with sufficient pull, and a trap behind it.
TEST(TraverseSimulation, RoverReachesTheGoalBehindWeakGroundAndATrap) {
  terramech::Soil weak = testSand();
  weak.friction_angle_rad = 0.44;
  const Site site{
      {.classes = {testSand()}, .patches = {{{30.0, 20.5}, 8.0, weak}, {{30.0, 20.5}, 4.0, testDust()}}},
      0.0};
  const TraverseSimulation drive = over(site, true);
  EXPECT_EQ(drive.outcome, Outcome::Reached);
  ASSERT_GE(drive.replans, 1);  // the weak ground is detected before the trap
}

TEST(TraverseSimulation, ExcessiveSlopeIsGivenUp) {
  EXPECT_EQ(over({{.classes = {testSand()}, .patches = {}}, 0.9}, false).outcome, Outcome::GaveUp);
}

TEST(TraverseSimulation, TrackIsConsistentWithTheDrive) {
  const TraverseSimulation drive = over(trapped(), true);
  ASSERT_GT(drive.track.size(), 10U);
  double length_m = 0.0;
  for (std::size_t i = 1; i < drive.track.size(); ++i) {
    const TrackPoint &a = drive.track[i - 1], &b = drive.track[i];
    length_m += std::hypot(b.place.x_m - a.place.x_m, b.place.y_m - a.place.y_m);
    EXPECT_GE(b.time_s, a.time_s);
    EXPECT_GE(b.energy_J, a.energy_J);
  }
  EXPECT_NEAR(length_m, drive.length_m, 1e-6);
  EXPECT_EQ(drive.events.front().text, "planned");
  EXPECT_EQ(drive.events.back().text, "reached");
  EXPECT_GE(drive.events.front().route.size(), 2U);
}

TraverseSimulation along(const std::vector<maps::Point>& route) {
  const TrueWorld world({.classes = {testSand()}, .patches = {}}, testRover(),
                        maps::Raster<std::uint8_t>(grid(), 0));
  costmap::TraversabilityMap map = planeMap(0.0);
  SimulationOptions options;
  options.start = route.front();
  options.goal = route.back();
  options.sensors = {.pose_drift = 0.0};
  options.planner = [&](const Problem&) { return Plan{.status = RouteStatus::Found, .points = route}; };
  return simulateTraverse(map, world, options);
}

// Closed form: turning.hpp with sinkage and rolling resistance from the mobility curve; the simulation uses
// its wheel table.
TEST(TraverseSimulation, TurnCostIsThatOfTheTrueGround) {
  const TraverseSimulation straight = along({{5.5, 20.5}, {15.5, 20.5}, {25.5, 20.5}}),
                           bent = along({{5.5, 20.5}, {15.5, 20.5}, {15.5, 30.5}});
  ASSERT_EQ(straight.outcome, Outcome::Reached);
  ASSERT_EQ(bent.outcome, Outcome::Reached);
  // For any initial direction the first heading is no turn.
  const TraverseSimulation north = along({{15.5, 5.5}, {15.5, 15.5}, {15.5, 25.5}});
  EXPECT_NEAR(north.time_s, straight.time_s, 0.01 * straight.time_s);
  EXPECT_NEAR(north.energy_J, straight.energy_J, 0.01 * straight.energy_J);
  const terramech::Rover rover = testRover();
  const terramech::SlopeState flat = terramech::SlopeEquilibrium(testSand(), rover).at({});
  const terramech::TurnEffort radian =
      terramech::turnEfforts(rover,
                             {.lateral_resistance = std::tan(testSand().friction_angle_rad),
                              .bulldozing_N = terramech::bulldozing_N(testSand(), rover, flat.sinkage_m),
                              .rolling_J_per_m = flat.energy_J_per_m - rover.hotel_power_W / flat.speed_mps})
          .at_vertex;
  const double quarter = 0.5 * std::numbers::pi;
  // After the turn the rear wheels leave the ruts of the front wheels for the length of the rover.
  const double energy = (bent.energy_J - straight.energy_J) / (quarter * radian.energy_J),
               time = (bent.time_s - straight.time_s) / (quarter * radian.time_s);
  EXPECT_GE(energy, 0.99);
  EXPECT_LE(energy, 1.1);
  EXPECT_GE(time, 0.99);
  EXPECT_LE(time, 1.1);
}

TEST(TraverseSimulation, SameSeedReproducesTheDrive) {
  const TraverseSimulation a = over(trapped(), true), b = over(trapped(), true);
  EXPECT_EQ(a.energy_J, b.energy_J);
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.track.size(), b.track.size());
}

}  // namespace traverse_simulation_test

}  // namespace talus::planner
