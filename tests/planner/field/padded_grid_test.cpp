#include <set>

#include <talus/planner/field/padded_grid.hpp>

namespace talus::planner {
namespace padded_grid_test {

// Property: each cell has its own index off the border, and its neighbours lie one offset away.
TEST(PaddedGrid, IndexAndCellAreInverse) {
  const PaddedGrid grid{.width = 5, .height = 3};
  std::set<std::size_t> seen;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const std::size_t index = grid.index({column, row});
      ASSERT_LT(index, grid.size());
      EXPECT_TRUE(seen.insert(index).second);
      EXPECT_EQ(grid.cell(index), (maps::Cell{column, row}));
      for (int heading = 0; heading < 8; ++heading) {
        const maps::Cell step = kStep[static_cast<std::size_t>(heading)];
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + grid.offset(heading));
        ASSERT_LT(next, grid.size());
        EXPECT_EQ(grid.cell(next), (maps::Cell{column + step.column, row + step.row}));
        EXPECT_EQ(grid.offset(heading), -grid.offset(opposite(heading)));
      }
    }
}

// Closed form: the box grows by one cell on each side, up to the edge of the grid.
TEST(PaddedGrid, GrownBoxesAreClippedToTheGrid) {
  const PaddedGrid grid{.width = 10, .height = 6};
  const CellBox inner = grown({{4, 2}, {5, 3}}, 1, grid);
  EXPECT_EQ(inner.first, (maps::Cell{3, 1}));
  EXPECT_EQ(inner.last, (maps::Cell{6, 4}));
  const CellBox all = grown({{1, 1}, {8, 5}}, 4, grid);
  EXPECT_EQ(all.first, (maps::Cell{0, 0}));
  EXPECT_EQ(all.last, (maps::Cell{9, 5}));
}

}  // namespace padded_grid_test
}  // namespace talus::planner
