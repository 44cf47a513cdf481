#include <cmath>
#include <memory>

#include <site_fixture.hpp>

#include <talus/planner/simulation/drive/wheel_alarm.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {
namespace wheel_alarm_test {

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
    EXPECT_NEAR(map.published()->cost().hold(slope(0.0, across), {1.0, 0.0}).slip_angle_rad,
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

}  // namespace wheel_alarm_test
}  // namespace talus::planner
