#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/surface/surface.hpp>
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

maps::Grid grid(int side, double resolution_m) {
  return {.width = side, .height = side, .resolution_m = resolution_m, .south_west = {}};
}

TEST(Inflate, KeepOutCellsAreInflatedByHalfTheRoverWidth) {
  maps::Raster<Hazard> hazards(grid(11, 0.1), Hazard::None);
  hazards[{5, 5}] = Hazard::KeepOut;
  HazardLimits limits;
  limits.inflation_m = 0.2;
  inflate(hazards, limits);
  // Closed form: cells with a point less than 0.2 m from the cell: one and two cells away, not three (0.2
  // m).
  EXPECT_TRUE(has(hazards[{6, 5}], Hazard::Near));
  EXPECT_TRUE(has(hazards[{7, 5}], Hazard::Near));
  EXPECT_FALSE(has(hazards[{8, 5}], Hazard::Near));
  EXPECT_TRUE(has(hazards[{7, 7}], Hazard::Near)) << "0.14 m";
  EXPECT_FALSE(has(hazards[{8, 7}], Hazard::Near)) << "0.22 m";
}

// Property: a free lane between rocks that is narrower than the rover is inflated entirely.
TEST(Inflate, RocksAreInflatedByHalfTheRoverWidth) {
  maps::Raster<Hazard> hazards(grid(11, 0.1), Hazard::None);
  for (int row = 0; row < 11; ++row) hazards[{2, row}] = hazards[{7, row}] = Hazard::Rocks;
  HazardLimits limits;
  limits.inflation_m = 0.2;
  inflate(hazards, limits);
  for (int column = 2; column <= 7; ++column) EXPECT_NE((hazards[{column, 5}]), Hazard::None) << column;
}

// Property: ground outside the map counts as unknown, like a hole.
TEST(Inflate, MapEdgeIsInflatedByHalfTheRoverWidth) {
  maps::Raster<Hazard> hazards(grid(11, 0.1), Hazard::None);
  HazardLimits limits;
  limits.inflation_m = 0.2;
  inflate(hazards, limits);
  for (int row = 0; row < 11; ++row)
    for (int column = 0; column < 11; ++column) {
      const bool inner = std::min({column, row, 10 - column, 10 - row}) >= 2;  // Closed form: 0.2 m off
      EXPECT_EQ((hazards[{column, row}]), inner ? Hazard::None : Hazard::Near) << column << ' ' << row;
    }
  hazards = maps::Raster<Hazard>(grid(11, 0.1), Hazard::None);
  inflate(hazards, limits, Hazard::KeepOut);
  EXPECT_EQ(std::ranges::count(hazards.values(), Hazard::None), 121) << "where the unseen may be driven";
}

// The centre of the rover may be anywhere in a cell, also at its edge.
TEST(Inflate, NeighboursOfCellsWiderThanTheRoverAreInflated) {
  maps::Raster<Hazard> hazards(grid(7, 5.0), Hazard::None);
  hazards[{3, 3}] = Hazard::Unknown;
  inflate(hazards, HazardLimits::of(testRover()));
  // Closed form: the eight neighbours and the 24 cells along the edge are inflated; the 16 cells between are
  // not.
  EXPECT_EQ(std::ranges::count(hazards.values(), Hazard::None), 16);
}

TEST(HazardLimits, ReliefLimitScalesWithWheelbaseOverFootprint) {
  const HazardLimits limits = HazardLimits::of(testRover());
  EXPECT_DOUBLE_EQ(reliefShare(limits, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(reliefShare(limits, 8.0), 0.1);  // Closed form: wheelbase 0.8 m over 8 m
}

TEST(ShapeJudge, EachExceededLimitIsNamed) {
  const HazardLimits limits{
      .max_gradient = 0.3, .max_step_m = 0.1, .max_roughness_m = 0.05, .wheelbase_m = 1.0};
  const ShapeJudge judge(limits, {.footprint_m = 2.0, .cell_m = 0.5});
  // Closed form: over 2 m, twice the wheelbase, relief and roughness count half; a step between cells counts
  // in full.
  EXPECT_EQ(judge({.dz_dx = 0.29F, .dz_dy = 0.0F, .roughness_m = 0.09F, .relief_m = 0.19F, .step_m = 0.09F}),
            Hazard::None);
  EXPECT_EQ(judge({.dz_dx = 0.25F, .dz_dy = 0.25F}), Hazard::Slope);
  EXPECT_EQ(judge({.roughness_m = 0.11F, .relief_m = 0.21F}), Hazard::Step | Hazard::Roughness);
  EXPECT_EQ(judge({.step_m = 0.11F}), Hazard::Step);
  EXPECT_EQ(ShapeJudge(limits, {.footprint_m = 4.0, .cell_m = 2.0})({.step_m = 0.19F}), Hazard::None);
  EXPECT_EQ(judge({.dz_dx = NAN}), Hazard::Unknown);
}

// Property: inflation in a box equals full inflation inside the box, and changes nothing outside.
TEST(Hazards, InflationInABoxEqualsFullInflation) {
  std::mt19937 random(5);
  const maps::Grid grid{.width = 30, .height = 24, .resolution_m = 0.5, .south_west = {}};
  for (int trial = 0; trial < 200; ++trial) {
    maps::Raster<Hazard> before(grid, Hazard::None);
    for (Hazard& h : before.values())
      if (random() % 12 == 0) h = random() % 2 == 0 ? Hazard::KeepOut : Hazard::Unknown;
    const HazardLimits limits{.inflation_m = 0.3 * static_cast<double>(random() % 6)};
    const Hazard spreading = random() % 2 == 0 ? kKeptClearOf : Hazard::KeepOut | Hazard::Obstacle;
    const maps::Cell first{static_cast<int>(random() % 30), static_cast<int>(random() % 24)};
    const maps::CellBox box{first,
                            {std::min(first.column + static_cast<int>(random() % 12), 29),
                             std::min(first.row + static_cast<int>(random() % 12), 23)}};
    maps::Raster<Hazard> everywhere = before, boxed = before;
    inflate(everywhere, limits, spreading);
    inflate(boxed, limits, spreading, box);
    forEachCell(allOf(grid), [&](maps::Cell c) {
      ASSERT_EQ(boxed[c], contains(box, c) ? everywhere[c] : before[c]) << trial;
    });
  }
}

}  // namespace surface_shape_test

}  // namespace talus::costmap
