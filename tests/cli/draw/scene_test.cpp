#include <cmath>

#include <talus/cli/draw/block_mean.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/talus.hpp>

#include "example_scene.hpp"

namespace talus::cli {
namespace {

TEST(Blocks, CoverTheMapAndLeaveOutNoData) {
  maps::Raster<float> fine({5, 4, 2.0, {10.0, 20.0}}, 1.0F);
  fine[{4, 0}] = 3.0F;
  fine[{0, 0}] = std::nanf("");
  const Blocks blocks(fine.grid(), 3);
  EXPECT_EQ(blocks.coarse(), (maps::Grid{3, 2, 4.0, {10.0, 20.0}}));
  const maps::Raster<float> mean = blocks.mean([&](maps::Cell c) { return fine[c]; });
  EXPECT_EQ((mean[{0, 0}]), 1.0F);
  EXPECT_EQ((mean[{2, 0}]), 2.0F);  // the cut block: one cell of 3 and one of 1
}

TEST(Blocks, ABlockWithoutDataHasNone) {
  const maps::Grid grid{4, 4, 1.0, {0.0, 0.0}};
  const maps::Raster<float> mean = Blocks(grid, 2).mean([](maps::Cell) { return std::nanf(""); });
  EXPECT_TRUE(std::isnan(mean[{1, 1}]));
}

TEST(Scene, SlopeOfAPlaneIsItsAngle) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({20, 20, 2.0, {0.0, 0.0}});
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column)
      map.elevation_m[{column, row}] = static_cast<float>(2.0 * row * std::tan(0.3));
  const Scene scene = sceneOf(map, {.title = "plane"});
  ASSERT_EQ(scene.layers.size(), 1U);
  // Closed form: atan of the gradient; 1e-4 deg for elevations stored as float.
  EXPECT_NEAR((scene.layers[0].values[{10, 10}]), 0.3 / kDegree, 1e-4);
}

TEST(Scene, OfALargeMapIsSmall) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({3000, 500, 1.0, {0.0, 0.0}}, 5.0F);
  const Scene scene = sceneOf(map, {.title = "large", .max_side = 1000});
  EXPECT_EQ(scene.grid().width, 1000);
  EXPECT_EQ(scene.grid().resolution_m, 3.0);
}

TEST(Scene, ARouteAloneLiesInsideItsGround) {
  const planner::Route route = exampleRoute();
  const Scene scene = sceneOf(route, {.title = "route"});
  for (const planner::RouteVertex& v : route.vertices) EXPECT_TRUE(scene.grid().cellAt({v.x_m, v.y_m}));
}

}  // namespace
}  // namespace talus::cli
