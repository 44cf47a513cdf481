#include <gtest/gtest.h>

#include <talus/costmap/cost/learned_cells.hpp>

namespace talus::costmap {
namespace learned_cells_test {

TEST(LearnedCells, CellsAreStoredAndChangesReported) {
  LearnedCells cells({.width = 200, .height = 100, .resolution_m = 1.0, .south_west = {}});
  EXPECT_EQ((cells[{199, 99}]), 0U);
  EXPECT_FALSE(cells.set({70, 5}, 0)) << "it was that before";
  EXPECT_TRUE(cells.boxes().empty());
  EXPECT_TRUE(cells.set({70, 5}, 7));
  EXPECT_FALSE(cells.set({70, 5}, 7));
  EXPECT_TRUE(cells.set({75, 9}, 8));
  EXPECT_EQ((cells[{70, 5}]), 7U);
  EXPECT_EQ((cells[{71, 5}]), 0U);
  ASSERT_EQ(cells.boxes().size(), 1U);
  EXPECT_EQ(cells.boxes()[0].first, (maps::Cell{70, 5}));
  EXPECT_EQ(cells.boxes()[0].last, (maps::Cell{75, 9}));
}

}  // namespace learned_cells_test
}  // namespace talus::costmap
