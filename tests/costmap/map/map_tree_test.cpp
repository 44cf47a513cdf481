#include <cmath>

#include <site_map.hpp>

#include <talus/costmap/map/map_tree.hpp>

namespace talus::costmap {
namespace map_tree_test {

TEST(MapTree, TreeContainsEveryCellAtItsHeight) {
  const TraversabilityMap map =
      mapOf({"11111222", "11111222", "11?11222", "11111#22", "11111122", "30111122"}, 0.3);
  const TraversabilityTree tree = treeOf(map);
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column) {
      const maps::Cell cell{column, row};
      const double elevation = static_cast<double>(map.elevation().elevation_m[cell]);
      if (std::isnan(elevation)) continue;
      const CellBelief* found = tree.find(map.surface().keys().key(cell, elevation));
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(*found, map.belief(cell)) << column << ' ' << row;
    }
}

}  // namespace map_tree_test
}  // namespace talus::costmap
