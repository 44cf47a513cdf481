#include "step.hpp"

#include <cmath>
#include <limits>

namespace safety {
namespace {

Raster made(double cell_m, double (*height)(double, double)) {
  Raster z{.width = 24, .height = 16, .west_m = 0.0, .south_m = 0.0, .cell_m = cell_m, .values = {}};
  for (int row = 0; row < z.height; ++row)
    for (int column = 0; column < z.width; ++column) {
      const Place p = z.centre({column, row});
      z.values.push_back(height(p.x_m, p.y_m));
    }
  return z;
}

TEST(SafetyStep, VerticalStepOnASlopeHasItsHeight) {
  const Raster z = made(0.25, [](double x, double y) { return 0.3 * x + 0.1 * y + (x > 3.0 ? 0.4 : 0.0); });
  const StepSpan span{.radius_m = 0.7, .wheel_m = 0.25};
  // Closed form: the edge lies between columns 11 and 12.
  EXPECT_NEAR(stepUnder(z, {11, 8}, span), 0.4, 1e-9);
  EXPECT_NEAR(stepUnder(z, {12, 8}, span), 0.4, 1e-9);
  EXPECT_NEAR(stepUnder(z, {9, 8}, span), 0.4, 1e-9) << "0.625 m off";
  EXPECT_NEAR(stepUnder(z, {8, 8}, span), 0.0, 1e-9) << "0.875 m off";
  EXPECT_NEAR(stepUnder(z, {0, 0}, span), 0.0, 1e-9) << "a corner of the map";
}

TEST(SafetyStep, HeightDifferencesWithinTheWheelSpanAddUp) {
  const Raster z = made(0.1, [](double x, double) { return 0.4 * std::clamp((x - 1.05) / 0.3, 0.0, 1.0); });
  EXPECT_NEAR(stepUnder(z, {10, 8}, {.radius_m = 0.0, .wheel_m = 0.3}), 0.4, 1e-9);
  EXPECT_NEAR(stepUnder(z, {10, 8}, {.radius_m = 0.0, .wheel_m = 0.1}), 0.4 / 3, 1e-9);
}

TEST(SafetyStep, NextToNoDataTheOppositeSlopeIsUsed) {
  Raster z = made(0.5, [](double x, double) { return 0.4 * x; });
  for (int row = 0; row < z.height; ++row)
    z.values[static_cast<std::size_t>(row * z.width + 9)] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(stepUnder(z, {8, 8}, {.radius_m = 0.0, .wheel_m = 0.2}), 0.0, 1e-9);
  for (int row = 0; row < z.height; ++row)
    z.values[static_cast<std::size_t>(row * z.width + 6)] = std::numeric_limits<double>::quiet_NaN();
  // Closed form: two cells between holes differ by 0.2 m in height; the slope of the sides is unknown.
  EXPECT_NEAR(stepUnder(z, {8, 8}, {.radius_m = 0.0, .wheel_m = 0.2}), 0.2, 1e-9);
}

}  // namespace
}  // namespace safety
