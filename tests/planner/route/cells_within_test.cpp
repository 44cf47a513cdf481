#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <talus/planner/route/cells_within.hpp>

namespace talus::planner {
namespace cells_within_test {

constexpr maps::Grid kGrid{.width = 7, .height = 5, .resolution_m = 0.5, .south_west = {10.0, 20.0}};

// Closed form, by brute force: a cell counts if its nearest point is within the radius.
TEST(CellsWithin, MatchesBruteForceOverCells) {
  for (double x = 9.113; x < 14.5; x += 0.37)
    for (double y = 19.2; y < 23.4; y += 0.41)
      for (const double radius_m : {0.1, 0.7, 1.9}) {
        std::vector<maps::Cell> expected;
        for (int row = 0; row < kGrid.height; ++row)
          for (int column = 0; column < kGrid.width; ++column) {
            const double west = 10.0 + 0.5 * column, south = 20.0 + 0.5 * row;
            const double dx = x - std::clamp(x, west, west + 0.5), dy = y - std::clamp(y, south, south + 0.5);
            if (std::hypot(dx, dy) <= radius_m) expected.push_back({column, row});
          }
        EXPECT_EQ(cellsWithin(kGrid, {x, y}, radius_m), expected) << x << ' ' << y << ' ' << radius_m;
      }
}

TEST(CellsWithin, NonFiniteAndDistantPlacesHaveNoCells) {
  for (const double far : {1e12, 1e300, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    for (const double radius_m : {0.0, 0.5, 1e3}) {
      EXPECT_TRUE(cellsWithin(kGrid, {far, 21.0}, radius_m).empty()) << far;
      EXPECT_TRUE(cellsWithin(kGrid, {11.0, -far}, radius_m).empty()) << far;
    }
  EXPECT_EQ(cellsWithin(kGrid, {11.0, 21.0}, 1e300).size(), kGrid.size());
}

}  // namespace cells_within_test
}  // namespace talus::planner
