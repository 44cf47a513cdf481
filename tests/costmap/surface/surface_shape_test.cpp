#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace surface_shape_test {

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

TEST(SurfaceShape, HeightChangesAreConfinedToTheReach) {
  const maps::Grid grid{.width = 41, .height = 41, .resolution_m = 0.5, .south_west = {}};
  maps::Raster<float> elevation_m(grid, 0.0F);
  elevation_m[{20, 20}] = 1.0F;
  for (const double radius_m : {0.1, 0.5, 0.8, 2.3, 3.0}) {
    const SurfaceShape shapes({.radius_m = radius_m, .step_span_m = 0.5 * radius_m});
    const int reach = shapes.reach(grid);
    shapes.measure(elevation_m, allOf(grid), {},
                   [&](maps::Cell c, const GroundShape& shape, Hazard) {
                     const int away = std::max(std::abs(c.column - 20), std::abs(c.row - 20));
                     EXPECT_TRUE(away <= reach || (shape.relief_m == 0.0F && shape.step_m == 0.0F))
                         << radius_m << ' ' << away;
                   },
                   {});
  }
}

}  // namespace surface_shape_test
}  // namespace talus::costmap
