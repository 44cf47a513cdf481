#include "plane.hpp"

#include <cmath>
#include <limits>

namespace safety {
namespace {

Raster made(double (*height)(double, double)) {
  Raster z{.width = 20, .height = 16, .west_m = 100.0, .south_m = -40.0, .cell_m = 0.5, .values = {}};
  for (int row = 0; row < z.height; ++row)
    for (int column = 0; column < z.width; ++column) {
      const Place p = z.centre({column, row});
      z.values.push_back(height(p.x_m, p.y_m));
    }
  return z;
}

TEST(SafetyPlane, FittedPlaneIsRecovered) {
  const Raster z = made([](double x, double y) { return 3.0 + 0.21 * x - 0.13 * y; });
  for (const Cell cell : {Cell{8, 8}, Cell{0, 0}, Cell{19, 3}}) {
    const Plane plane = planeUnder(z, cell, 0.8);
    ASSERT_TRUE(plane.known);
    // Closed form: the fit returns the given plane, also at a corner of the map.
    EXPECT_NEAR(plane.east, 0.21, 1e-9);
    EXPECT_NEAR(plane.north, -0.13, 1e-9);
    EXPECT_NEAR(plane.relief_m, 0.0, 1e-9);
  }
}

TEST(SafetyPlane, StepLeavesItsResidualRelief) {
  const Raster z = made([](double x, double) { return x > 104.0 ? 1.0 : 0.0; });
  // Closed form: over 3x3 cells, heights 0, 0, 1 have residuals 1/6, -1/3, 1/6 of the step.
  const Plane plane = planeUnder(z, {7, 8}, 0.1);
  EXPECT_NEAR(plane.east, 1.0, 1e-9);
  EXPECT_NEAR(plane.relief_m, 0.5, 1e-9);
}

TEST(SafetyPlane, CellOrDiscWithoutDataIsUnknown) {
  Raster z = made([](double, double) { return 0.0; });
  z.values[static_cast<std::size_t>(8 * z.width + 8)] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(planeUnder(z, {8, 8}, 0.8).known);
  EXPECT_TRUE(planeUnder(z, {9, 8}, 0.8).known);
  EXPECT_FALSE(planeUnder(z, {-1, 0}, 0.8).known);
}

}  // namespace
}  // namespace safety
