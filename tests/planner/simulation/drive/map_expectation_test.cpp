#include <cmath>
#include <memory>

#include <site_fixture.hpp>

#include <talus/planner/simulation/drive/map_expectation.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::planner {
namespace map_expectation_test {

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

}  // namespace map_expectation_test
}  // namespace talus::planner
