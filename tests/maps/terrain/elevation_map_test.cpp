#include <limits>
#include <random>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {
namespace elevation_map_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(ElevationMap, ValidFractionIsTheShareOfCellsWithData) {
  Raster<float> z({.width = 4, .height = 2, .resolution_m = 1.0, .south_west = {}}, 1.0F);
  EXPECT_EQ(validFraction(z), 1.0);
  z[{1, 1}] = z[{3, 0}] = kNaN;
  EXPECT_EQ(validFraction(z), 0.75);
}

TEST(ElevationMap, InterpolationIsBilinear) {
  const Grid grid{.width = 6, .height = 5, .resolution_m = 2.0, .south_west = {100.0, 50.0}};
  Raster<float> z(grid);
  // Closed form: bilinear interpolation reproduces a + b x + c y + d x y.
  const auto height = [](Point p) { return 3.0 + 0.5 * p.x_m - 0.25 * p.y_m + 0.125 * p.x_m * p.y_m; };
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      z[{column, row}] = static_cast<float>(height(grid.centre({column, row})));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(101.0, 111.0), y(51.0, 59.0);
  for (int i = 0; i < 200; ++i) {
    const Point p{x(random), y(random)};
    const auto seen = elevationAt(z, p);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(*seen, height(p), 1e-3);  // tolerance: float storage of some 700 m
  }
}

// Closed form: between the outermost centres and the edge of the map the elevation is not extrapolated.
TEST(ElevationMap, ElevationIsConstantBeyondTheOutermostCentres) {
  Raster<float> z(Grid{.width = 3, .height = 2, .resolution_m = 2.0});
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 3; ++c) z[{c, r}] = static_cast<float>(10 * c + r);
  EXPECT_EQ(elevationAt(z, {0.1, 0.1}), 0.0);
  EXPECT_EQ(elevationAt(z, {5.9, 3.9}), 21.0);
  EXPECT_EQ(elevationAt(z, {2.0, 3.9}), 6.0);
  EXPECT_FALSE(elevationAt(z, {6.0, 1.0}));
}

TEST(ElevationMap, OutsideTheMapAndNextToNoDataThereIsNoElevation) {
  Raster<float> z({.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}}, 5.0F);
  z[{1, 1}] = kNaN;
  EXPECT_FALSE(elevationAt(z, {-0.1, 2.0}));
  EXPECT_FALSE(elevationAt(z, {2.0, 4.1}));
  EXPECT_FALSE(elevationAt(z, {1.6, 1.6}));
  EXPECT_EQ(elevationAt(z, {3.2, 3.2}), 5.0);
}

}  // namespace elevation_map_test
}  // namespace talus::maps
