#include <limits>
#include <random>

#include <talus/maps/maps.hpp>

namespace talus::maps {
namespace grid_test {

constexpr Grid kGrid{.width = 7, .height = 4, .resolution_m = 0.5, .south_west = {10.0, -20.0}};

TEST(Grid, CellAtInvertsCentre) {
  for (int row = 0; row < kGrid.height; ++row)
    for (int column = 0; column < kGrid.width; ++column)
      EXPECT_EQ(kGrid.cellAt(kGrid.centre({column, row})), (Cell{column, row}));
}

TEST(Grid, CellsIncludeTheirSouthAndWestEdgesOnly) {
  // Closed form: cell (c, r) is the half-open square from its south-west corner.
  EXPECT_EQ(kGrid.cellAt({10.0, -20.0}), (Cell{0, 0}));
  EXPECT_EQ(kGrid.cellAt({10.5, -19.5}), (Cell{1, 1}));
  EXPECT_FALSE(kGrid.cellAt({13.5, -19.0}));
  EXPECT_FALSE(kGrid.cellAt({12.0, -18.0}));
}

TEST(Grid, PointsOutsideTheMapAndNanHaveNoCell) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(kGrid.cellAt({9.999, -19.0}));
  EXPECT_FALSE(kGrid.cellAt({kNaN, -19.0}));
  EXPECT_FALSE(kGrid.cellAt({11.0, kNaN}));
  EXPECT_FALSE(kGrid.cellAt({kInfinity, -19.0}));
  EXPECT_FALSE(kGrid.cellAt({11.0, -kInfinity}));
}

TEST(Grid, IndicesAreRowMajor) {
  std::size_t expected = 0;
  for (int row = 0; row < kGrid.height; ++row)
    for (int column = 0; column < kGrid.width; ++column) EXPECT_EQ(kGrid.index({column, row}), expected++);
  EXPECT_EQ(kGrid.size(), expected);
}

TEST(Raster, ValueCountMustEqualCellCount) {
  EXPECT_THROW(Raster<int>(kGrid, std::vector<int>(27)), std::invalid_argument);
  const Raster<int> raster(kGrid, std::vector<int>(28, 3));
  EXPECT_EQ((raster[{6, 3}]), 3);
  EXPECT_EQ(raster.row(1), raster.values().data() + 7);
}

}  // namespace grid_test
}  // namespace talus::maps
