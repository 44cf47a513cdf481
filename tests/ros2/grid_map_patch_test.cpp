#include "grid_map_patch.hpp"

#include <cmath>

#include "small_site.hpp"

namespace talus_ros2 {
namespace {

// A grid map of 6 x 4 m, cells of 0.5 m, around a place; its height is 100 x + y at each cell's middle, by the definition of
// grid_map: the middle of index (i, j), unwrapped, lies at position + (length - resolution) / 2 - (i, j) resolution.
grid_map::GridMap seen(double x_m, double y_m, grid_map::Index start = {0, 0}) {
  grid_map::GridMap map({"elevation"});
  map.setFrameId("map");
  map.setGeometry({6.0, 4.0}, 0.5, {x_m, y_m});
  map.setStartIndex(start);
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j) {
      const double x = x_m + 0.5 * (6.0 - 0.5) - 0.5 * i, y = y_m + 0.5 * (4.0 - 0.5) - 0.5 * j;
      map.get("elevation")((i + start(0)) % 12, (j + start(1)) % 8) = static_cast<float>(100.0 * x + y);
    }
  return map;
}

TEST(GridMap, HeightsAreAssignedToTheirCellsForAnyStartIndex) {
  const auto map = smallSite();
  for (const grid_map::Index& start :
       {grid_map::Index{0, 0}, grid_map::Index{5, 3}, grid_map::Index{11, 7}}) {
    const auto patch = patchOf(seen(4.0, 10.0, start), "elevation", map.grid());
    ASSERT_TRUE(patch);
    const talus::maps::Grid& window = patch->elevation_m.grid();
    // Closed form: a map of 6 x 4 m around (4, 10) begins at (1, 8).
    EXPECT_EQ(window.width, 12);
    EXPECT_EQ(window.height, 8);
    EXPECT_DOUBLE_EQ(window.south_west.x_m, 1.0);
    EXPECT_DOUBLE_EQ(window.south_west.y_m, 8.0);
    for (int row = 0; row < 8; ++row)
      for (int column = 0; column < 12; ++column) {
        const auto at = window.centre({column, row});
        EXPECT_FLOAT_EQ((patch->elevation_m[{column, row}]), static_cast<float>(100.0 * at.x_m + at.y_m));
      }
  }
}

TEST(GridMap, PatchIsClippedToTheMap) {
  auto map = smallSite();
  const auto patch = patchOf(seen(-5.0, 3.0, {2, 1}), "elevation", map.grid());
  ASSERT_TRUE(patch);
  EXPECT_EQ(patch->elevation_m.grid().width, 6);
  EXPECT_EQ(patch->elevation_m.grid().height, 4);
  EXPECT_FLOAT_EQ((patch->elevation_m[{0, 0}]), static_cast<float>(100.0 * -4.75 + 3.25));
  EXPECT_FALSE(patchOf(seen(500.0, 10.0), "elevation", map.grid()));
}

TEST(GridMap, UnobservedCellsAreUnchanged) {
  auto map = smallSite();
  grid_map::GridMap gaps = seen(4.0, 10.0);
  gaps.get("elevation").setConstant(NAN);
  EXPECT_FALSE(patchOf(gaps, "elevation", map.grid()));
  gaps.get("elevation")(3, 2) = 0.25F;  // x = 4 + 2.75 - 1.5, y = 10 + 1.75 - 1
  map.patch(*patchOf(gaps, "elevation", map.grid()));
  int changed = 0;
  for (const float height_m : map.elevation().elevation_m.values()) changed += height_m != 0.0F;
  EXPECT_EQ(changed, 1);
  EXPECT_EQ((map.elevation().elevation_m[*map.grid().cellAt({5.25, 10.75})]), 0.25F);
}

TEST(GridMap, MapRoundTripsExactly) {
  auto map = smallSite();
  map.patch(*patchOf(seen(-2.0, 4.0), "elevation", map.grid()));  // steep, and in a corner
  const grid_map::GridMap out = gridMapOf(map, "map");
  EXPECT_EQ(out.getFrameId(), "map");
  const auto back = patchOf(out, "elevation", map.grid());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->elevation_m.grid(), map.grid());
  EXPECT_EQ(back->elevation_m.values(), map.elevation().elevation_m.values());
  // Property: of each cell, what the map has of it; the wall is dangerous.
  const CellsOf cells(out);
  const auto wall = cells.index(*map.grid().cellAt({10.7, 8.0})),
             open = cells.index(*map.grid().cellAt({20.0, 8.0}));
  EXPECT_EQ(out.get("category")(wall(0), wall(1)), 2.0F);
  EXPECT_EQ(out.get("category")(open(0), open(1)), 0.0F);
  EXPECT_GT(out.get("drawbar_pull")(open(0), open(1)), 0.0F);
}

TEST(GridMap, InvalidMessagesAreRejectedWithOneLine) {
  const auto map = smallSite();
  const auto refused = [&](const grid_map::GridMap& given, const char* layer, const char* word) {
    try {
      patchOf(given, layer, map.grid());
      ADD_FAILURE() << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(word));
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
    }
  };
  refused(seen(4.0, 10.0), "height", "no layer 'height'");
  refused(seen(4.1, 10.0), "elevation", "lie between the map's");
  refused(seen(4.0, 10.2), "elevation", "lie between the map's");
  grid_map::GridMap coarse({"elevation"});
  coarse.setGeometry({6.0, 4.0}, 1.0, {4.0, 10.0});
  refused(coarse, "elevation", "resolution 1.000000 m, the map's is 0.500000 m");
}

}  // namespace
}  // namespace talus_ros2
