#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <refused.hpp>
#include <site_fixture.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/costmap/surface/surface_shape.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace surface_tree_test {

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

// A step of five cells in height, so that the surface contains gaps of several voxels.
MapLayers cliff() {
  MapLayers layers = drawn({"1111", "11?1", "1111", "1111"});
  for (int row = 0; row < 4; ++row) layers.elevation.elevation_m[{3, row}] += 5.0F;
  return layers;
}

TEST(SurfaceTree, ColourTreeHasOneLeafPerCellAndIsReadByOctoMap) {
  const TraversabilityMap map(cliff(), testGround(), {});
  const auto tree = colorTree({map.elevation().elevation_m, map.surface().keys()},
                              [&](maps::Cell c) { return map.belief(c); });
  EXPECT_EQ(tree->getNumLeafNodes(), 15U);  // Closed form: 16 cells, one without elevation
  std::stringstream stream;
  tree->write(stream);
  const std::unique_ptr<octomap::AbstractOcTree> back(octomap::AbstractOcTree::read(stream));
  const auto* colour = dynamic_cast<octomap::ColorOcTree*>(back.get());
  ASSERT_NE(colour, nullptr);
  const auto* cell = colour->search(map.surface().keys().key({0, 0}, 1000.0));
  ASSERT_NE(cell, nullptr);
  EXPECT_GT(cell->getColor().r, cell->getColor().g) << "at the edge of the map, refused: red";
}

std::string held(const TraversabilityMap& map) {
  std::ostringstream stream;
  writeTree(treeOf(map), stream);
  return stream.str();
}

std::string streamed(const TraversabilityMap& map) {
  std::ostringstream stream;
  writeTree(map, stream);
  return stream.str();
}

// Property: the streamed bytes equal those of a tree in memory, on even and rough ground, with and without
// evidence, for uniform and for empty maps.
TEST(SurfaceTree, StreamedBytesEqualTheTree) {
  EXPECT_EQ(streamed(TraversabilityMap(drawn({"??", "??"}), testGround(), {})),
            held(TraversabilityMap(drawn({"??", "??"}), testGround(), {})));
  EXPECT_EQ(streamed(mapOf({"1"})), held(mapOf({"1"})));
  EXPECT_EQ(streamed(TraversabilityMap(cliff(), testGround(), {})),
            held(TraversabilityMap(cliff(), testGround(), {})));
  std::mt19937 random(3);
  for (const double rise : {0.0, 0.3}) {
    std::vector<std::string> rows(50, std::string(70, '1'));
    for (auto& line : rows)
      for (char& c : line) c = "11111111112?#"[random() % 13];
    TraversabilityMap map = mapOf(rows, rise);
    EXPECT_EQ(streamed(map), held(map));
    for (int i = 0; i < 200; ++i)
      map.learn(
          {.time_s = 1.0,
           .place = {100.0 + static_cast<double>(random() % 70), 200.0 + static_cast<double>(random() % 50)},
           .pull = {0.2, 0.05},
           .sinkage = {0.2, 0.05}});
    map.publish();
    EXPECT_EQ(streamed(map), held(map));
  }
}

TEST(SurfaceTree, WithoutElevationTheTreeIsEmpty) {
  MapLayers layers = drawn({"??", "??"});
  const TraversabilityMap map(std::move(layers), testGround(), {});
  EXPECT_EQ(treeOf(map).size(), 0U);
  EXPECT_EQ(colorTree({map.elevation().elevation_m, map.surface().keys()},
                      [&](maps::Cell c) { return map.belief(c); })
                ->size(),
            0U);
}

// A slope of voxels with a slab above a section of the slope and free space between.
template <typename Tree>
void fill(Tree& tree) {
  const auto voxel = [](int column, int row, double z) {
    return octomap::point3d(static_cast<float>(0.1 * column + 0.05), static_cast<float>(0.1 * row + 0.05),
                            static_cast<float>(z));
  };
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 10; ++y) {
      tree.updateNode(voxel(x, y, 0.1 * (x / 4) + 0.05), true);
      tree.updateNode(voxel(x, y, 2.05), false);
      if (x < 5) tree.updateNode(voxel(x, y, 1.05), true);
    }
  tree.updateInnerOccupancy();
}

void expectSlopeUnderSlab(const maps::ElevationMap& map) {
  ASSERT_EQ(map.grid().width, 20);
  ASSERT_EQ(map.grid().height, 10);
  // Closed form: the slope of fill(); heights are voxel centres, stored as floats.
  EXPECT_NEAR(map.elevation_m[(maps::Cell{2, 3})], 1.05, 1e-6);
  EXPECT_NEAR(map.elevation_m[(maps::Cell{12, 3})], 0.35, 1e-6);
  EXPECT_NEAR(map.grid().centre({12, 3}).x_m, 1.25, 1e-9);
}

TEST(OctomapSurface, ReadsFullBinaryAndColourTrees) {
  octomap::OcTree tree(0.1);
  fill(tree);
  std::stringstream full, binary, coloured;
  tree.write(full);
  tree.writeBinaryConst(binary);
  octomap::ColorOcTree colour(0.1);
  fill(colour);
  colour.write(coloured);
  expectSlopeUnderSlab(octomapGround(full, "a.ot"));
  expectSlopeUnderSlab(octomapGround(binary, "a.bt"));
  expectSlopeUnderSlab(octomapGround(coloured, "c.ot"));
}

// Closed form: one voxel in each octant; the cell of its column is where the voxel is.
TEST(OctomapSurface, EveryOctantKeepsItsCoordinates) {
  for (int octant = 0; octant < 8; ++octant) {
    const auto sign = [&](int axis) { return octant >> axis & 1 ? 1.0 : -1.0; };
    const octomap::point3d at(static_cast<float>(3.05 * sign(0)), static_cast<float>(7.25 * sign(1)),
                              static_cast<float>(1.15 * sign(2)));
    octomap::OcTree tree(0.1);
    tree.updateNode(at, true);
    std::stringstream stream;
    tree.writeBinaryConst(stream);
    const maps::ElevationMap map = octomapGround(stream, "octant.bt");
    ASSERT_EQ(map.grid().size(), 1U);
    EXPECT_NEAR(map.grid().centre({0, 0}).x_m, 3.05 * sign(0), 1e-6) << octant;
    EXPECT_NEAR(map.grid().centre({0, 0}).y_m, 7.25 * sign(1), 1e-6) << octant;
    EXPECT_NEAR((map.elevation_m[{0, 0}]), 1.15 * sign(2), 1e-6) << octant;
  }
}

TEST(OctomapSurface, CeilingSelectsTheGroundBelow) {
  octomap::OcTree tree(0.1);
  fill(tree);
  std::stringstream stream;
  tree.writeBinaryConst(stream);
  const maps::ElevationMap ground = octomapGround(stream, "a.bt", 0.8);
  EXPECT_NEAR(ground.elevation_m[(maps::Cell{2, 3})], 0.05, 1e-6);
  EXPECT_NEAR(ground.elevation_m[(maps::Cell{12, 3})], 0.35, 1e-6);
  stream.seekg(0);
  EXPECT_THROW(octomapGround(stream, "a.bt", -1.0), InputError);
}

// Property: a rock of two voxels above the ground leaves no headroom, and a gap in a scan is no headroom.
TEST(OctomapSurface, GroundRequiresFreeHeadroom) {
  for (const double slab_m : {0.35, 0.55, 0.65}) {
    octomap::OcTree tree(0.1);
    tree.updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
    tree.updateNode(octomap::point3d(0.05F, 0.05F, static_cast<float>(slab_m)), true);
    std::stringstream stream;
    tree.write(stream);
    // Closed form: 2, 4 and 5 voxels between ground and slab are free; headroom of half a metre needs 5.
    if (slab_m > 0.6)
      EXPECT_NEAR((octomapGround(stream, "a.ot", 0.2).elevation_m[{0, 0}]), 0.05, 1e-6);
    else
      EXPECT_REFUSED(octomapGround(stream, "a.ot", 0.2), InputError, "no ground at or below");
  }
}

TEST(OctomapSurface, EveryTruncationIsRejected) {
  octomap::OcTree tree(0.1);
  fill(tree);
  for (const bool binary : {false, true}) {
    std::ostringstream out;
    if (binary)
      tree.writeBinaryConst(out);
    else
      tree.write(out);
    const std::string bytes = out.str();
    for (std::size_t length = 0; length < bytes.size(); length += 3) {
      std::istringstream in(bytes.substr(0, length));
      EXPECT_THROW(octomapGround(in, "cut.ot"), InputError) << length;
    }
  }
}

// An OcTree whose only leaf is `depth` levels below the root, with the given voxel size.
std::string oneCube(int depth, const std::string& resolution) {
  std::string bytes = "# Octomap OcTree file\nid OcTree\nsize 2\nres " + resolution + "\ndata\n";
  for (int k = 0; k < depth; ++k) bytes += std::string("\0\0\0\0\x01", 5);
  return bytes + std::string("\0\0\x80\x3f\0", 5);
}

// Closed form: the cube begins at the lowest key and has the side 2^(16 - depth); its top voxel is at side -
// 0.5 - 2^15.
TEST(OctomapSurface, LargeLeafIsASurfaceOfItsFullWidth) {
  std::istringstream stream(oneCube(6, "0.1"));
  const maps::ElevationMap ground = octomapGround(stream, "cube.ot");
  EXPECT_EQ(ground.grid().width, 1024);
  for (const maps::Cell cell : {maps::Cell{0, 0}, maps::Cell{511, 3}, maps::Cell{1023, 1023}})
    EXPECT_FLOAT_EQ(ground.elevation_m[cell], static_cast<float>((1023.5 - 32768.0) * 0.1));
}

// Property: a small file that declares a huge extent is rejected before memory or time is spent.
TEST(OctomapSurface, OversizedLeavesAreRejected) {
  for (const int depth : {0, 1}) {
    std::istringstream stream(oneCube(depth, "0.1"));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "columns, more than 4e8") << depth;
  }
}

TEST(OctomapSurface, VoxelSizesOutOfRangeAreRejected) {
  for (const char* resolution : {"1e-300", "1e-4", "1e7", "1e308"}) {
    std::istringstream stream(oneCube(16, resolution));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "must be 0.001 m to 1000 km") << resolution;
  }
  for (const char* resolution : {"nan", "inf", "-0.1", ""}) {
    std::istringstream stream(oneCube(16, resolution));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "not an OctoMap file") << resolution;
  }
}

TEST(OctomapSurface, UnsupportedTreeTypeIsRejected) {
  std::istringstream stream("# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\ndata\n");
  EXPECT_THROW(octomapGround(stream, "x.ot"), InputError);
  EXPECT_FALSE(octomapType("/dev/null").has_value());
}

using octomap::OcTreeKey;

CellBelief sandy() {
  return {.pull_mean = 0.25F,
          .pull_std = 0.05F,
          .sinkage_mean = 0.2F,
          .terrain_class = 2,
          .category = 0,
          .confidence = 16};
}

TraversabilityTree sample() {
  TraversabilityTree tree(0.5);
  for (unsigned short x = 0; x < 8; ++x)
    for (unsigned short y = 0; y < 8; ++y) tree.at(OcTreeKey(32768 + x, 32768 + y, 32770)) = sandy();
  tree.at(OcTreeKey(32770, 32770, 32770)).evidence = 3.5F;
  tree.prune();
  return tree;
}

std::string bytesOf(const TraversabilityTree& tree) {
  std::ostringstream stream;
  writeTree(tree, stream);
  return stream.str();
}

TraversabilityTree fromBytes(const std::string& bytes) {
  std::istringstream stream(bytes);
  return readTree(stream, "map.ot");
}

TEST(TraversabilityTree, EqualCellsArePrunedAndDifferingCellsKept) {
  const TraversabilityTree tree = sample();
  // Property: 64 cells that are equal except one need far fewer leaves, and each cell can still be read.
  EXPECT_LT(tree.getNumLeafNodes(), 12U);
  EXPECT_EQ(tree.find(OcTreeKey(32770, 32770, 32770))->evidence, 3.5F);
  EXPECT_EQ(*tree.find(OcTreeKey(32775, 32769, 32770)), sandy());
  EXPECT_EQ(tree.find(OcTreeKey(100, 100, 100)), nullptr);
}

TEST(TraversabilityTree, SplittingAPrunedCubeKeepsTheOtherCells) {
  TraversabilityTree tree = sample();
  tree.at(OcTreeKey(32775, 32775, 32770)).pull_mean = -0.1F;
  EXPECT_EQ(*tree.find(OcTreeKey(32774, 32775, 32770)), sandy());
  EXPECT_EQ(tree.find(OcTreeKey(32775, 32775, 32770))->pull_mean, -0.1F);
}

TEST(TraversabilityTree, SerialisationIsDeterministicAndRoundTrips) {
  const std::string bytes = bytesOf(sample());
  EXPECT_EQ(bytes, bytesOf(sample()));
  EXPECT_EQ(bytes, bytesOf(fromBytes(bytes)));
  const TraversabilityTree copy = fromBytes(bytes);
  EXPECT_EQ(bytes, bytesOf(TraversabilityTree(copy)));
}

TEST(TraversabilityTree, TypeIsRegisteredWithOctoMap) {
  std::istringstream stream(bytesOf(sample()));
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  const auto* ours = dynamic_cast<TraversabilityTree*>(tree.get());
  ASSERT_NE(ours, nullptr);
  EXPECT_EQ(bytesOf(*ours), bytesOf(sample()));
}

TEST(TraversabilityTree, EveryTruncationIsRejected) {
  const std::string bytes = bytesOf(sample());
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(fromBytes(bytes.substr(0, length)), InputError) << length;
}

TEST(TraversabilityTree, DamagedBytesAreReadOrRejected) {
  const std::string bytes = bytesOf(sample());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xff);
    try {
      fromBytes(damaged);
    } catch (const InputError&) {
    }
  }
}

TEST(TraversabilityTree, UnsupportedTreeTypeIsNamedInTheError) {
  try {
    fromBytes("# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.1\ndata\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "map.ot: OctoMap tree of type 'ColorOcTree', not TraversabilityTree; a point-cloud OctoMap "
                 "is read as a DEM");
  }
}

}  // namespace surface_tree_test
}  // namespace talus::costmap
