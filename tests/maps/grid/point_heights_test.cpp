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
namespace point_heights_test {

using testing::HasSubstr;

constexpr Grid kGrid{.width = 7, .height = 5, .resolution_m = 0.5, .south_west = {10.0, -2.0}};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Property: the height equals that from sorting each cell's points separately, for any order of the cloud.
TEST(PointHeights, HeightsArePercentilesOfThePointsOfACell) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<CloudPoint> cloud;
  for (int k = 0; k < 2000; ++k) cloud.push_back({9.0 + 6.0 * uniform(), -3.0 + 5.0 * uniform(), uniform()});
  for (const HeightChoice choice :
       {HeightChoice{}, HeightChoice{0.5, 3}, HeightChoice{0.9, 1}, HeightChoice{0.01, 9}}) {
    const Raster<float> heights = heightsOf(cloud, kGrid, choice);
    for (int row = 0; row < kGrid.height; ++row)
      for (int column = 0; column < kGrid.width; ++column) {
        std::vector<float> own;
        for (const CloudPoint& p : cloud)
          if (kGrid.cellAt({p.x_m, p.y_m}) == Cell{column, row}) own.push_back(static_cast<float>(p.z_m));
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
    const Raster<float> again = heightsOf(cloud, kGrid, choice);
    for (std::size_t i = 0; i < kGrid.size(); ++i)
      EXPECT_TRUE(again.values()[i] == heights.values()[i] || std::isnan(heights.values()[i]));
  }
}

TEST(PointHeights, NonFiniteAndOutsidePointsAreIgnored) {
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<CloudPoint> cloud{{10.1, -1.9, 1.0}, {10.1, -1.9, kNaN}, {10.2, -1.8, infinite},
                                      {kNaN, -1.9, 9.0}, {1e300, 0.0, 9.0},  {10.3, -1.9, 1e300},
                                      {13.5, -1.9, 9.0}};
  EXPECT_EQ((heightsOf(cloud, kGrid)[{0, 0}]), 1.0F);
}

TEST(PointHeights, InvalidOptionsAndEmptyCloudsAreRejected) {
  const std::vector<CloudPoint> one{{10.1, -1.9, 1.0}}, off{{0.0, 0.0, 1.0}};
  const auto refusal = [](const std::vector<CloudPoint>& cloud, const HeightChoice& choice) -> std::string {
    try {
      heightsOf(cloud, kGrid, choice);
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

}  // namespace point_heights_test
}  // namespace talus::maps
