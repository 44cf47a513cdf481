#include <cmath>
#include <set>
#include <utility>

#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {
namespace footprint_test {

TEST(Footprint, ContainsCellsWithCentresWithinTheRadius) {
  for (const double radius : {1.5, 2.0, 2.9, 5.0, 7.3}) {
    const Footprint disc = discFootprint(radius);
    std::set<std::pair<int, int>> held;
    for (const auto& o : disc.offsets) held.insert({o.column, o.row});
    ASSERT_EQ(held.size(), disc.offsets.size());
    // Closed form, by brute force: every cell of a larger square is checked.
    for (int row = -9; row <= 9; ++row)
      for (int column = -9; column <= 9; ++column)
        EXPECT_EQ(held.contains({column, row}), std::hypot(column, row) <= radius + 1e-9)
            << radius << ": " << column << ' ' << row;
  }
}

TEST(Footprint, SmallRadiusYieldsThreeByThreeCells) {
  EXPECT_EQ(discFootprint(0.1).offsets.size(), 9U);
  EXPECT_EQ(discFootprint(0.1).reach, 1);
}

TEST(Footprint, MomentsMatchTheOffsets) {
  for (const double radius : {1.0, 3.0, 6.4}) {
    const Footprint disc = discFootprint(radius);
    double x = 0.0, xy = 0.0, xx = 0.0, yy = 0.0;
    int reach = 0;
    for (const auto& o : disc.offsets) {
      x += o.column, xy += o.column * o.row;
      xx += o.column * o.column, yy += o.row * o.row;
      reach = std::max(reach, std::abs(o.column));
    }
    // Property: the footprint is symmetric, so that the plane's normal equations are diagonal.
    EXPECT_EQ(x, 0.0);
    EXPECT_EQ(xy, 0.0);
    EXPECT_EQ(xx, yy);
    EXPECT_EQ(disc.sum_xx, xx);
    EXPECT_EQ(disc.reach, reach);
  }
}

}  // namespace footprint_test
}  // namespace talus::maps
