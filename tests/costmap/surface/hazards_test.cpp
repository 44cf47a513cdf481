#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/surface/surface.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {

namespace hazards_test {

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

}  // namespace hazards_test

}  // namespace talus::costmap
