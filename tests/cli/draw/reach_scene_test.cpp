#include <cmath>
#include <memory>
#include <vector>

#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/reach_scene.hpp>

namespace talus::cli {
namespace reach_scene_test {

// Flat ground of 30 x 20 cells.
maps::ElevationMap level() {
  maps::ElevationMap map;
  map.elevation_m =
      maps::Raster<float>({.width = 30, .height = 20, .resolution_m = 1.0, .south_west = {}}, 5.0F);
  return map;
}

// Scene of two places without a connection over the cells.
Scene severed(const maps::ElevationMap& map, const maps::Raster<costmap::CellCode>& cells) {
  costmap::TravelCurve curve;
  curve.cost_J_per_m.fill(1.0F);
  const costmap::CostGrid cost = costmap::flattened(
      cells, std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curve}));
  return reachScene(map, cost, {{{2.5, 3.5}, {27.5, 16.5}}, 0.0, "a wall"}, {.title = "severed"});
}

TEST(ReachScene, BothCellSetsAndTheGapAreShown) {
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
TEST(ReachScene, SmallSetIsMarkedByARing) {
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

}  // namespace reach_scene_test
}  // namespace talus::cli
