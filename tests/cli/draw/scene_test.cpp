#include <cmath>

#include <talus/cli/draw/scene.hpp>
#include <talus/common/constants.hpp>

#include "example_scene.hpp"

namespace talus::cli {
namespace scene_test {

TEST(Scene, SlopeOfAPlaneIsItsAngle) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({20, 20, 2.0, {0.0, 0.0}});
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column)
      map.elevation_m[{column, row}] = static_cast<float>(2.0 * row * std::tan(0.3));
  const Scene scene = sceneOf(map, {.title = "plane"});
  ASSERT_EQ(scene.layers.size(), 2U);
  EXPECT_EQ(scene.layers[1].name, "elevation");
  // Closed form: atan of the gradient; tolerance 1e-4 deg, because elevations are stored as float.
  EXPECT_NEAR((scene.layers[0].values[{10, 10}]), 0.3 / kDegree, 1e-4);
}

TEST(Scene, LargeMapIsReducedToTheMaximumSide) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({3000, 500, 1.0, {0.0, 0.0}}, 5.0F);
  const Scene scene = sceneOf(map, {.title = "large", .max_side = 1000});
  EXPECT_EQ(scene.grid().width, 1000);
  EXPECT_EQ(scene.grid().resolution_m, 3.0);
}

TEST(Scene, SceneGridContainsTheRoute) {
  const planner::Route route = exampleRoute();
  const Scene scene = sceneOf(route, {.title = "route"});
  for (const planner::RouteVertex& v : route.vertices) EXPECT_TRUE(scene.grid().cellAt({v.x_m, v.y_m}));
}

TEST(Scene, DifferingAndEqualFactsAreSeparated) {
  Scene scene = sceneOf(exampleMap(), {.title = "two"});
  NamedRoute first{"a", exampleRoute(), {{"soil", "sand"}, {"seed", "1"}}};
  NamedRoute second{"b", exampleRoute(), {{"soil", "clay"}, {"seed", "1"}}};
  second.route.summary.energy_J = 60000.0;
  compare(scene, {first, second});
  std::vector<std::string> differing;
  for (const ComparedFact& fact : scene.comparison) {
    differing.push_back(fact.name);
    EXPECT_EQ(fact.values.size(), 2U);
  }
  EXPECT_THAT(differing, testing::ElementsAre("energy", "soil"));
  EXPECT_THAT(scene.facts, testing::Contains(Fact("seed", "1")));
  EXPECT_EQ(scene.routes.size(), 2U);
}

}  // namespace scene_test
}  // namespace talus::cli
