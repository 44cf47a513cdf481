#include <algorithm>
#include <cmath>

#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plugin/windowed_route.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kCell_m = 2.0;
const maps::Grid kWhole{.width = 700, .height = 500, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

// Rolling ground, the same at any place whatever window it is sampled in.
float height(maps::Point p) {
  return static_cast<float>(4.0 * std::sin(p.x_m / 60.0) * std::cos(p.y_m / 45.0));
}

std::shared_ptr<const costmap::GroundModel> model() {
  terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.centre_of_mass_height_m = 0.4;
  rover.max_torque_Nm = 60.0;
  const terramech::Soil soil{.name = "firm",
                             .cohesion_Pa = 2000.0,
                             .friction_angle_rad = 0.6,
                             .sinkage_exponent = 1.0,
                             .cohesive_modulus = 1400.0,
                             .frictional_modulus = 2e6,
                             .shear_modulus_m = 0.018};
  static const auto made = std::make_shared<const costmap::GroundModel>(
      costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = soil}}, .policy = {}});
  return made;
}

costmap::TraversabilityMap built(const maps::Grid& grid) {
  costmap::MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.elevation.elevation_m[{column, row}] = height(grid.centre({column, row}));
  return costmap::TraversabilityMap(std::move(layers), model(), {});
}

maps::Grid gridOf(const MapBox& box) {
  return {.width = static_cast<int>(std::lround((box.high.x_m - box.low.x_m) / kCell_m)),
          .height = static_cast<int>(std::lround((box.high.y_m - box.low.y_m) / kCell_m)),
          .resolution_m = kCell_m,
          .south_west = box.low};
}

WindowedMap windows(int& asked) {
  maps::Grid coarse = kWhole;
  coarse.width /= 5, coarse.height /= 5, coarse.resolution_m *= 5;
  return WindowedMap(
      {.grid = kWhole, .overview = built(coarse).published(), .build = [&asked](const MapBox& box) {
         ++asked;
         return std::optional(built(gridOf(box)));
       }});
}

TEST(WindowedMap, TilesBesideALineAreThoseOfTheWholeMapToTheBit) {
  // Property: the same cell codes as of the map built as a whole, and the rest unknown.
  int asked = 0;
  WindowedMap map = windows(asked);
  const std::vector<maps::Point> line{{250.0, 100.0}, {900.0, 400.0}};
  const auto near = map.around(line, 64.0);
  const auto whole = built(kWhole).published();
  std::size_t same = 0, unknown = 0;
  for (int row = 0; row < kWhole.height; ++row)
    for (int column = 0; column < kWhole.width; ++column) {
      const costmap::CellCode code = near->at({column, row});
      if (code.curve() == costmap::CellCode::kUnknown)
        ++unknown;
      else if (code == whole->at({column, row}))
        ++same;
      else
        FAIL() << "another code at " << column << ", " << row;
    }
  EXPECT_GT(same, 60'000U);
  EXPECT_GT(unknown, 100'000U);
  EXPECT_LE(map.cellsBuilt(), 300'000U);
  ASSERT_TRUE(map.elevation_m({500.0, 215.0}));
  EXPECT_NEAR(*map.elevation_m({500.0, 215.0}), height({500.0, 215.0}), 0.02);  // bilinear between 2 m cells
  EXPECT_FALSE(map.elevation_m({1400.0, -40.0}));
  const int before = asked;
  map.around(line, 64.0);
  EXPECT_EQ(asked, before);  // what is held is not built again
}

TEST(WindowedMap, ARouteIsThatOfTheWholeMapWithinAFewPercent) {
  int asked = 0;
  WindowedMap map = windows(asked);
  PlanRequest request;
  request.start = {150.0, 0.0};
  request.goal = {1400.0, 850.0};
  const Route route = routeInWindows(request, map);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(
      std::ranges::all_of(route.vertices, [](const auto& v) { return std::isfinite(v.elevation_m); }));
  // Property: the whole map allows it at the same price.
  std::vector<maps::Point> points;
  for (const RouteVertex& v : route.vertices) points.push_back({v.x_m, v.y_m});
  const double price_J = MotionCost(built(kWhole).published()).along(points);
  EXPECT_NEAR(price_J, route.summary.cost, 1e-6 * price_J);
}

TEST(WindowedMap, SaysWhatItCannotDo) {
  EXPECT_THROW(WindowedMap({.grid = kWhole}), std::invalid_argument);
  int asked = 0;
  WindowedMap map = windows(asked);
  EXPECT_THAT([&] { routeInWindows({}, map, {.planner = "hybrid"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'hybrid' does not plan in windows")));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { routeInWindows(request, map); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad")));
  WindowedMap shifted({.grid = kWhole, .overview = map.overview(), .build = [](const MapBox& box) {
                         maps::Grid grid = gridOf(box);
                         grid.south_west.x_m += 1.0;
                         return std::optional(built(grid));
                       }});
  EXPECT_THROW(shifted.around({{250.0, 100.0}}, 10.0), std::invalid_argument);
}

}  // namespace
}  // namespace talus::planner
