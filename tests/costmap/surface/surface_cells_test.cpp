#include <algorithm>
#include <limits>
#include <random>

#include <talus/costmap/surface/surface_cells.hpp>

namespace talus::costmap {
namespace surface_cells_test {

constexpr maps::Grid kGrid{.width = 21, .height = 13, .resolution_m = 0.5, .south_west = {3.0, -7.0}};

TEST(SurfaceKeys, HeightsRoundTripWithinHalfAVoxel) {
  const SurfaceKeys keys(kGrid, -4500.0);
  for (const double height : {-4510.3, -4500.0, -4499.9, -4321.1})
    EXPECT_NEAR(-4500.0 + (keys.key({0, 0}, height)[2] - 32768 + 0.5) * 0.5, height, 0.25 + 1e-9);
}

TEST(SurfaceKeys, TreeCoordinatesAreMapMetresMinusOrigin) {
  const SurfaceKeys keys(kGrid, 0.0);
  // Closed form: OctoMap's voxel k spans (k - 32768) to (k - 32767) times the resolution.
  for (const maps::Cell cell : {maps::Cell{0, 0}, maps::Cell{20, 12}, maps::Cell{7, 3}}) {
    const auto key = keys.key(cell, 0.0);
    EXPECT_NEAR(keys.origin().x_m + (key[0] - 32768 + 0.5) * 0.5, kGrid.centre(cell).x_m, 1e-9);
    EXPECT_NEAR(keys.origin().y_m + (key[1] - 32768 + 0.5) * 0.5, kGrid.centre(cell).y_m, 1e-9);
  }
}

TEST(SurfaceKeys, HeightsAreClampedAndTooManyCellsRejected) {
  const SurfaceKeys keys(kGrid, 0.0);
  EXPECT_EQ(keys.key({0, 0}, 1e9)[2], 65535);
  EXPECT_EQ(keys.key({0, 0}, -1e9)[2], 0);
  maps::Grid wide = kGrid;
  wide.width = 65537;
  EXPECT_THROW(SurfaceKeys(wide, 0.0), std::invalid_argument);
}

// Property: every block contains the lowest and the highest key of its cells, by brute force.
TEST(SurfacePyramid, BlocksContainTheKeyRangeOfTheirCells) {
  const SurfaceKeys keys(kGrid, 0.0);
  maps::Raster<float> z(kGrid);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> height(-20.0F, 20.0F);
  for (float& value : z.values())
    value = random() % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : height(random);
  const SurfacePyramid pyramid(z, keys);
  const auto first = keys.key({0, 0}, 0.0);
  for (unsigned level = 0; level < 6; ++level) {
    const unsigned side = 1U << level;
    for (unsigned y = first[1] / side * side; y < first[1] + 13U; y += side)
      for (unsigned x = first[0] / side * side; x < first[0] + 21U; x += side) {
        SurfacePyramid::Range expected;
        for (int row = 0; row < kGrid.height; ++row)
          for (int column = 0; column < kGrid.width; ++column) {
            const auto key = keys.key({column, row}, static_cast<double>(z[{column, row}]));
            if (std::isnan(z[{column, row}]) || key[0] / side * side != x || key[1] / side * side != y)
              continue;
            expected.low = std::min(expected.low, key[2]), expected.high = std::max(expected.high, key[2]);
          }
        const auto seen = pyramid.range(level, x, y);
        ASSERT_EQ(seen.low, expected.low) << level << ' ' << x << ' ' << y;
        ASSERT_EQ(seen.high, expected.high) << level << ' ' << x << ' ' << y;
      }
  }
}

}  // namespace surface_cells_test
}  // namespace talus::costmap
