#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

using testing::HasSubstr;

constexpr Grid kHeightGrid{.width = 7, .height = 5, .resolution_m = 0.5, .south_west = {10.0, -2.0}};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Property: the height equals that from sorting each cell's points separately, for any order of the cloud.
TEST(PointHeights, HeightsArePercentilesOfThePointsOfACell) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<CloudPoint> cloud;
  for (int k = 0; k < 2000; ++k) cloud.push_back({9.0 + 6.0 * uniform(), -3.0 + 5.0 * uniform(), uniform()});
  for (const HeightChoice choice :
       {HeightChoice{}, HeightChoice{0.5, 3}, HeightChoice{0.9, 1}, HeightChoice{0.01, 9}}) {
    const Raster<float> heights = heightsOf(cloud, kHeightGrid, choice);
    for (int row = 0; row < kHeightGrid.height; ++row)
      for (int column = 0; column < kHeightGrid.width; ++column) {
        std::vector<float> own;
        for (const CloudPoint& p : cloud)
          if (kHeightGrid.cellAt({p.x_m, p.y_m}) == Cell{column, row})
            own.push_back(static_cast<float>(p.z_m));
        const float taken = heights[{column, row}];
        if (own.size() < choice.least_points) {
          EXPECT_TRUE(std::isnan(taken));
          continue;
        }
        const auto below =
            static_cast<double>(std::ranges::count_if(own, [&](float z) { return z <= taken; }));
        const auto under =
            static_cast<double>(std::ranges::count_if(own, [&](float z) { return z < taken; }));
        // The height is the lowest point at or above the percentile.
        EXPECT_GE(below, choice.percentile * static_cast<double>(own.size()) - 1e-9);
        EXPECT_LT(under, choice.percentile * static_cast<double>(own.size()));
      }
    std::ranges::shuffle(cloud, random);
    const Raster<float> again = heightsOf(cloud, kHeightGrid, choice);
    for (std::size_t i = 0; i < kHeightGrid.size(); ++i)
      EXPECT_TRUE(again.values()[i] == heights.values()[i] || std::isnan(heights.values()[i]));
  }
}

TEST(PointHeights, NonFiniteAndOutsidePointsAreIgnored) {
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<CloudPoint> cloud{{10.1, -1.9, 1.0}, {10.1, -1.9, kNaN}, {10.2, -1.8, infinite},
                                      {kNaN, -1.9, 9.0}, {1e300, 0.0, 9.0},  {10.3, -1.9, 1e300},
                                      {13.5, -1.9, 9.0}};
  EXPECT_EQ((heightsOf(cloud, kHeightGrid)[{0, 0}]), 1.0F);
}

TEST(PointHeights, InvalidOptionsAndEmptyCloudsAreRejected) {
  const std::vector<CloudPoint> one{{10.1, -1.9, 1.0}}, off{{0.0, 0.0, 1.0}};
  const auto refusal = [](const std::vector<CloudPoint>& cloud, const HeightChoice& choice) -> std::string {
    try {
      heightsOf(cloud, kHeightGrid, choice);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "taken";
  };
  EXPECT_THAT(refusal(one, {.percentile = 0.0}), HasSubstr("percentile = 0.000000"));
  EXPECT_THAT(refusal(one, {.percentile = 1.5}), HasSubstr("must be above 0 and at most 1"));
  EXPECT_THAT(refusal(one, {.percentile = kNaN}), HasSubstr("percentile"));
  EXPECT_THAT(refusal(one, {.least_points = 0}), HasSubstr("least_points = 0"));
  EXPECT_THAT(refusal(one, {.least_points = 2}), HasSubstr("no cell of the grid has 2 of its 1 points"));
  EXPECT_THAT(refusal(off, {}), HasSubstr("no cell of the grid"));
  EXPECT_THAT(refusal({}, {}), HasSubstr("0 points"));
}

}  // namespace grid_test
}  // namespace talus::maps
