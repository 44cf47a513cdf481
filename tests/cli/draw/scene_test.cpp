#include <cmath>
#include <memory>
#include <random>

#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/common/common.hpp>

#include "example_scene.hpp"

namespace talus::cli {

namespace scene_test {

// Property: the factor is the smallest that limits both sides to max_side; block means equal brute-force
// means, and a map within max_side is unchanged.
TEST(Blocks, FactorIsMinimalAndMeansMatchBruteForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1.0F, 1.0F);
  for (const int most : {7, 8, 20, 50}) {
    maps::Raster<float> fine({50, 33, 2.0, {-3.0, 7.0}});
    for (float& each : fine.values()) each = value(random);
    const Blocks blocks(fine.grid(), most);
    const maps::Grid& coarse = blocks.coarse();
    const int factor = static_cast<int>(std::lround(coarse.resolution_m / 2.0));
    EXPECT_LE(std::max(coarse.width, coarse.height), most);
    if (factor > 1) {
      EXPECT_GT((50 + factor - 2) / (factor - 1), most);
    }
    EXPECT_GE(coarse.width * factor, 50);
    EXPECT_LT((coarse.width - 1) * factor, 50);
    const auto mean = blocks.mean([&](maps::Cell c) { return fine[c]; });
    for (int row = 0; row < coarse.height; ++row)
      for (int column = 0; column < coarse.width; ++column) {
        double sum = 0.0;
        int count = 0;
        for (int r = row * factor; r < std::min((row + 1) * factor, 33); ++r)
          for (int c = column * factor; c < std::min((column + 1) * factor, 50); ++c)
            sum += static_cast<double>(fine[{c, r}]), ++count;
        EXPECT_NEAR((mean[{column, row}]), sum / count, 1e-6) << factor;
      }
  }
}

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
  second.route.energy_J = 60000.0;
  for (std::size_t i = 4; i < 7; ++i) second.route.vertices[i].y_m += 1e4;
  compare(scene, {first, second});
  std::vector<std::string> differing;
  for (const ComparedFact& fact : scene.comparison) {
    differing.push_back(fact.name);
    EXPECT_EQ(fact.values.size(), 2U);
  }
  EXPECT_THAT(differing,
              testing::ElementsAre("energy", "safe", "marginal", "soil", testing::StartsWith("1: ")));
  EXPECT_THAT(scene.comparison[0].values[1], testing::HasSubstr("60 kJ (+"));
  EXPECT_THAT(scene.facts, testing::Contains(Fact("seed", "1")));
  EXPECT_EQ(scene.routes.size(), 2U);
}

// Flat ground of 30 x 20 cells.
maps::ElevationMap level() {
  maps::ElevationMap map;
  map.elevation_m =
      maps::Raster<float>({.width = 30, .height = 20, .resolution_m = 1.0, .south_west = {}}, 5.0F);
  return map;
}

// Scene of two places without a connection over the cells.
Scene severed(const maps::ElevationMap& map, const maps::Raster<costmap::CellCode>& cells) {
  const costmap::TravelCurve curve(std::vector<float>(costmap::TravelCurve::kBins, 1.0F));
  const costmap::CostGrid cost = costmap::flattened(
      cells, std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curve}));
  return reachScene(map, cost, {{{2.5, 3.5}, {27.5, 16.5}}, 0.0, "a wall"}, {.title = "severed"});
}

TEST(Scene, BothCellSetsAndTheGapAreShown) {
  const maps::ElevationMap map = level();
  maps::Raster<costmap::CellCode> cells(map.grid(), costmap::CellCode({.curve = 0}));
  for (int row = 0; row < 20; ++row)
    cells[{12, row}] = costmap::CellCode({.curve = costmap::CellCode::kBlocked});
  const Scene scene = severed(map, cells);
  ASSERT_FALSE(scene.layers.empty());
  const auto& reached = scene.layers.front().values;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 30; ++column) {
      const float value = reached[{column, row}];
      if (column == 12)
        EXPECT_TRUE(std::isnan(value));
      else
        EXPECT_EQ(value, column < 12 ? 0.0F : 1.0F) << column << ' ' << row;
    }
  // Both sets are large and need no ring; the title contains the reason.
  ASSERT_EQ(scene.layers.front().classes.size(), 2U);
  EXPECT_EQ(scene.layers.front().classes[0].name, "reached from the start: 240 cells");
  EXPECT_EQ(scene.layers.front().classes[1].name, "leading to the goal: 340 cells");
  EXPECT_TRUE(scene.rings.empty());
  EXPECT_EQ(scene.title, "severed: a wall");
  EXPECT_FALSE(drawPicture(scene).empty());
  Scene unmarked = scene;
  unmarked.marks.clear();
  EXPECT_NE(drawPicture(scene), drawPicture(unmarked));
}

// A ring marks a small set of 5 x 6 cells in a corner.
TEST(Scene, SmallSetIsMarkedByARing) {
  const maps::ElevationMap map = level();
  maps::Raster<costmap::CellCode> cells(map.grid(), costmap::CellCode({.curve = 0}));
  const costmap::CellCode blocked({.curve = costmap::CellCode::kBlocked});
  for (int row = 0; row <= 6; ++row) cells[{5, row}] = blocked;
  for (int column = 0; column <= 5; ++column) cells[{column, 6}] = blocked;
  const Scene scene = severed(map, cells);
  ASSERT_EQ(scene.rings.size(), 1U);
  EXPECT_EQ(scene.rings[0].label, "reached from the start: 30 cells");
  EXPECT_EQ(scene.rings[0].centre.x_m, 2.5);
  EXPECT_EQ(scene.rings[0].centre.y_m, 3.0);
  EXPECT_DOUBLE_EQ(scene.rings[0].radius_m, 0.5 * std::hypot(4.0, 5.0));
}

}  // namespace scene_test

}  // namespace talus::cli
