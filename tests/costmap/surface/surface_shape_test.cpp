#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace surface_shape_test {

// Number of rocks per square metre with a diameter above d, by quadrature of the definition.
double rocksByQuadrature(double k, double d) {
  const double q = 1.79 + 0.152 / k;
  const double step = 1e-4;
  double sum = 0.0;
  for (double x = d + 0.5 * step; x < 20.0; x += step)
    sum += k * q * std::exp(-q * x) * 4.0 / (std::numbers::pi * x * x) * step;
  return sum;
}

TEST(RockHazard, MatchesItsDefinition) {
  for (const double k : {0.01, 0.05, 0.2, 0.4})
    for (const double d : {0.1, 0.4, 1.0}) {
      // Closed form: midpoint rule over the same density, good to 1e-5 at this step.
      const double expected = 1.0 - std::exp(-rocksByQuadrature(k, d) * 2.5);
      EXPECT_NEAR(rockHazard(k, {.diameter_m = d, .area_m2 = 2.5}), expected, 1e-5 * expected + 1e-12);
    }
}

TEST(RockHazard, WithoutRocksTheHazardIsZero) {
  EXPECT_EQ(rockHazard(0.0, {.diameter_m = 0.1, .area_m2 = 1.0}), 0.0);
  EXPECT_EQ(rockHazard(std::numeric_limits<double>::quiet_NaN(), {.diameter_m = 0.1, .area_m2 = 1.0}), 0.0);
}

// Property: the hazard never decreases with rock abundance. (The fitted distribution alone would leave 0.55
// of such places free at an abundance of 0.9.)
TEST(RockHazard, HazardIsMonotoneInRockAbundance) {
  const RockCrossing fido{.diameter_m = 0.46, .area_m2 = 0.7};
  double last = 0.0;
  for (int percent = 1; percent <= 100; ++percent) {
    const double now = rockHazard(0.01 * percent, fido);
    EXPECT_GE(now, last) << percent;
    last = now;
  }
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(rockHazard(0.51, fido), 1.0);
}

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

maps::Raster<float> plane(double dz_dx, double dz_dy) {
  maps::Raster<float> z({.width = 30, .height = 20, .resolution_m = 0.5, .south_west = {}}, 0.0F);
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 30; ++column)
      z[{column, row}] = static_cast<float>(0.5 * (dz_dx * column + dz_dy * row));
  return z;
}

// Closed form: on a plane the heights around a hole yield the plane's slope for any width of the hole;
// single precision.
TEST(UnseenSlope, PlaneSlopeIsRecovered) {
  std::mt19937 random(1);
  maps::Raster<float> z = plane(0.3, -0.2);
  for (float& height : z.values())
    if (random() % 3 != 0) height = kNone;
  int seen = 0;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 30; ++column) {
      const UnseenSlope slope = unseenSlope(z, {column, row});
      for (const auto& [said, want] : {std::pair{slope.dz_dx, 0.3}, {slope.dz_dy, -0.2}}) {
        if (said == 0.0) continue;  // no known height on one side
        EXPECT_NEAR(said, want, 1e-5);
        ++seen;
      }
    }
  EXPECT_GT(seen, 700);
}

TEST(UnseenSlope, SlopeIsZeroBeyondTheReach) {
  maps::Raster<float> z({.width = 400, .height = 3, .resolution_m = 1.0, .south_west = {}}, kNone);
  z[{100, 1}] = 0.0F;
  z[{150, 1}] = -25.0F;
  EXPECT_EQ(unseenSlope(z, {125, 1}).dz_dx, -0.5);
  EXPECT_EQ(unseenSlope(z, {132, 1}).dz_dx, -0.5);
  EXPECT_EQ(unseenSlope(z, {133, 1}).dz_dx, 0.0);
  EXPECT_EQ(unseenSlope(z, {99, 1}).dz_dx, 0.0);
  EXPECT_EQ(unseenSlope(z, {125, 1}).dz_dy, 0.0);
}

// Property: metrics of a box are bit-identical to those of terrainMetrics() on the whole map. Each cell of
// the box appears once, and a height changes no cell beyond reach().
TEST(SurfaceShape, ShapeOfABoxEqualsTheWhole) {
  std::mt19937 random(3);
  const maps::Grid grid{.width = 50, .height = 320, .resolution_m = 0.5, .south_west = {3.0, 4.0}};
  maps::Raster<float> elevation_m(grid);
  for (float& h : elevation_m.values())
    h = random() % 50 == 0 ? NAN : static_cast<float>(1e-4 * static_cast<double>(random() % 10000));
  const auto same = [](float a, float b) { return std::isnan(a) ? std::isnan(b) : a == b; };
  for (const double radius_m : {0.1, 0.8, 2.3, 12.0}) {
    const maps::FootprintOptions footprint{.radius_m = radius_m, .step_span_m = 1.6, .threads = 2};
    const auto whole = maps::terrainMetrics(elevation_m, footprint);
    for (const maps::CellBox& box :
         {maps::CellBox{{3, 7}, {44, 305}}, {{0, 0}, {0, 0}}, {{49, 300}, {49, 319}}}) {
      maps::Raster<int> visits(grid, 0);
      SurfaceShape(footprint).measure(
          elevation_m, box, {},
          [&](maps::Cell c, const GroundShape& shape, Hazard) {
            ++visits[c];
            ASSERT_TRUE(same(shape.dz_dx, whole.dz_dx[c]) && same(shape.dz_dy, whole.dz_dy[c]) &&
                        same(shape.roughness_m, whole.roughness_m[c]) &&
                        same(shape.relief_m, whole.relief_m[c]) && same(shape.step_m, whole.step_m[c]))
                << radius_m << ": " << c.column << ' ' << c.row;
          },
          {});
      forEachCell(allOf(grid), [&](maps::Cell c) { ASSERT_EQ(visits[c], contains(box, c) ? 1 : 0); });
    }
  }
}

}  // namespace surface_shape_test
}  // namespace talus::costmap
