#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/ground/class_borders.hpp>

namespace talus::costmap {
namespace class_borders_test {

// Closed form, by brute force: each cell is compared with every cell around it.
TEST(ClassBorders, BordersAreCellsWithAnotherClassWithinReach) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const maps::Grid grid{.width = 1 + static_cast<int>(random() % 15),
                          .height = 1 + static_cast<int>(random() % 15),
                          .resolution_m = 1.0,
                          .south_west = {}};
    maps::Raster<std::uint8_t> classes(grid, 1);
    for (std::uint8_t& c : classes.values())
      if (random() % 20 == 0) c = 2;
    const int reach = 1 + trial % 4;
    const auto border = classBorders(classes, reach);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        bool other = false;
        for (int dy = -reach; dy <= reach; ++dy)
          for (int dx = -reach; dx <= reach; ++dx) {
            const maps::Cell near{column + dx, row + dy};
            other = other || (grid.contains(near) && classes[near] != classes[{column, row}]);
          }
        ASSERT_EQ(border[grid.index({column, row})], other) << trial << ' ' << column << ' ' << row;
      }
  }
  EXPECT_TRUE(classBorders({}, 2).empty());
}

}  // namespace class_borders_test
}  // namespace talus::costmap
