#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <cost_bits.hpp>
#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace map_surface_test {

using maps::Cell;
using maps::CellBox;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

int whole(std::mt19937& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
}

// Ground with hills, steps, holes in the data, rocks and three classes, one of them without a soil.
float height(std::mt19937& random, Cell c, double level_m) {
  if (uniform(random, 0.0, 1.0) < 0.02) return kNaN;
  const double step = uniform(random, 0.0, 1.0) < 0.01 ? 0.6 : 0.0;
  return static_cast<float>(level_m + 0.4 * std::sin(0.2 * c.column) * std::cos(0.15 * c.row) + step +
                            uniform(random, -0.01, 0.01));
}

std::uint8_t classOf(std::mt19937& random, Cell c) {
  const double other = uniform(random, 0.0, 1.0);
  if (other < 0.005) return 255;
  if (other < 0.01) return 3;
  return (c.column / 9 + c.row / 7) % 3 == 0 ? 2 : 1;
}

MapLayers ground(std::mt19937& random, const maps::Grid& grid) {
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  layers.classes = maps::Raster<std::uint8_t>(grid);
  layers.rock_abundance = maps::Raster<float>(grid, 0.0F);
  layers.keep_out = maps::Raster<std::uint8_t>(grid, 0);
  forEachCell(allOf(grid), [&](Cell c) {
    layers.elevation.elevation_m[c] = height(random, c, 0.0);
    layers.classes[c] = classOf(random, c);
    if (uniform(random, 0.0, 1.0) < 0.01) layers.rock_abundance[c] = 0.9F;
    if (uniform(random, 0.0, 1.0) < 0.01) layers.keep_out[c] = 1;
  });
  return layers;
}

// A patch anywhere, also at borders and over the whole map, with some of the layers and with holes.
SurfacePatch window(std::mt19937& random, const maps::Grid& grid) {
  const Cell first{whole(random, 0, 3) == 0 ? 0 : whole(random, 0, grid.width - 1),
                   whole(random, 0, 3) == 0 ? 0 : whole(random, 0, grid.height - 1)};
  maps::Grid part = grid;
  part.width = whole(random, 0, 3) == 0 ? grid.width - first.column
                                        : whole(random, 1, std::min(20, grid.width - first.column));
  part.height = whole(random, 0, 3) == 0 ? grid.height - first.row
                                         : whole(random, 1, std::min(20, grid.height - first.row));
  part.south_west = {grid.south_west.x_m + first.column * grid.resolution_m,
                     grid.south_west.y_m + first.row * grid.resolution_m};
  const int layers = whole(random, 1, 15);
  const double level_m = uniform(random, -0.2, 0.2);
  SurfacePatch patch;
  if (layers & 1) patch.elevation_m = maps::Raster<float>(part);
  if (layers & 2) patch.rock_abundance = maps::Raster<float>(part);
  if (layers & 4) patch.classes = maps::Raster<std::uint8_t>(part);
  if (layers & 8) patch.keep_out = maps::Raster<std::uint8_t>(part);
  forEachCell(allOf(part), [&](Cell c) {
    const Cell there{first.column + c.column, first.row + c.row};
    const bool first_cell = c.column == 0 && c.row == 0;  // the first cell always has data
    if (layers & 1) patch.elevation_m[c] = first_cell ? 0.1F : height(random, there, level_m);
    if (layers & 2) patch.rock_abundance[c] = first_cell ? 0.0F : std::array{kNaN, 0.0F, 0.9F}[random() % 3];
    if (layers & 4) patch.classes[c] = first_cell ? 1 : classOf(random, {there.column + 4, there.row});
    if (layers & 8) patch.keep_out[c] = static_cast<std::uint8_t>(uniform(random, 0.0, 1.0) < 0.01);
  });
  return patch;
}

// Writes a patch into the layers for the full build, independent of the map's own bookkeeping.
void lay(const SurfacePatch& patch, MapLayers& layers) {
  const maps::Grid& grid = layers.elevation.elevation_m.grid();
  const auto each = [&](const auto& layer, const auto& take) {
    if (layer.empty()) return;
    forEachCell(allOf(layer.grid()), [&](Cell c) { take(*grid.cellAt(layer.grid().centre(c)), layer[c]); });
  };
  each(patch.elevation_m, [&](Cell c, float h) {
    if (!std::isnan(h)) layers.elevation.elevation_m[c] = h;
  });
  each(patch.rock_abundance, [&](Cell c, float share) {
    if (!std::isnan(share)) layers.rock_abundance[c] = share;
  });
  each(patch.classes, [&](Cell c, std::uint8_t number) {
    if (number != 255) layers.classes[c] = number;
  });
  each(patch.keep_out, [&](Cell c, std::uint8_t out) { layers.keep_out[c] = out; });
}

WheelObservation drive(std::mt19937& random, const maps::Grid& grid) {
  WheelObservation seen;
  seen.place = {grid.south_west.x_m + uniform(random, 0.0, grid.width * grid.resolution_m),
                grid.south_west.y_m + uniform(random, 0.0, grid.height * grid.resolution_m)};
  seen.pull = {uniform(random, 0.05, 0.4), 0.05};
  seen.sinkage = {uniform(random, 0.05, 0.4), 0.05};
  seen.trust = Trust::Once;
  seen.sinkage_verified = true;
  return seen;
}

void expectSame(const TraversabilityMap& patched, const TraversabilityMap& at_once) {
  const auto a = patched.published(), b = at_once.published();
  forEachCell(allOf(patched.grid()), [&](Cell c) {
    const std::string where = std::to_string(c.column) + ' ' + std::to_string(c.row);
    ASSERT_EQ(patched.surface().hazards(c), at_once.surface().hazards(c)) << where;
    ASSERT_EQ(patched.belief(c), at_once.belief(c)) << where;
    ASSERT_EQ(a->at(c).stepsX(), b->at(c).stepsX()) << where;
    ASSERT_EQ(a->at(c).stepsY(), b->at(c).stepsY()) << where;
    ASSERT_EQ(a->at(c).curve() >= CellCode::kUnknown ? a->at(c).curve() : 0,
              b->at(c).curve() >= CellCode::kUnknown ? b->at(c).curve() : 0)
        << where;
    ASSERT_EQ(costBits(*a, c), costBits(*b, c)) << where;
  });
}

struct Case {
  unsigned seed = 1;
  int threads = 1;
  double resolution_m = 0.25, footprint_m = 0.5;
  int rounds = 8;
  int most_drives = 4;  // few drives, so that the curve indices suffice without coarser rounding
  TravelPolicy policy{};
};

// Property: after patches and drives in any order the map is bit-identical to one built from the patched
// layers and the same evidence. If the map ran out of curve numbers, the maps are equal after the numbers
// are assigned again.
void patchedIsAtOnce(const Case& how) {
  std::mt19937 random(how.seed);
  const maps::Grid grid{
      .width = 60, .height = 66, .resolution_m = how.resolution_m, .south_west = {10.0, -7.0}};
  const auto model = testGround(how.policy);
  MapLayers layers = ground(random, grid);
  TraversabilityMap map(layers, model, {.footprint_radius_m = how.footprint_m, .threads = how.threads});
  std::vector<std::pair<maps::Point, double>> refused;
  for (int round = 0, drives = 0; round < how.rounds; ++round) {
    for (int k = whole(random, 0, 3); k > 0 && drives < how.most_drives; --k, ++drives)
      map.learn(drive(random, grid));
    if (round == 5) {
      refused.push_back({grid.centre({30, 30}), 0.9});
      map.refuse(refused.back().first, refused.back().second);
    }
    const SurfacePatch patch = window(random, grid);
    const auto before = map.published()->version();
    map.patch(patch);
    ASSERT_EQ(map.published()->version(), before + 1);
    lay(patch, layers);
    TraversabilityMap at_once(layers, model, {.footprint_radius_m = how.footprint_m, .threads = 1});
    map.evidence().visit([&](const SavedBlock& block) { ASSERT_TRUE(at_once.restore(block)); });
    for (const auto& [place, radius_m] : refused) at_once.refuse(place, radius_m);
    at_once.publishAll();
    if (how.most_drives > 4) map.publishAll();
    expectSame(map, at_once);
    if (testing::Test::HasFatalFailure()) {
      ADD_FAILURE() << "seed " << how.seed << ", round " << round;
      return;
    }
  }
}

TEST(MapSurface, PatchedEqualsFullBuild) {
  for (unsigned seed = 1; seed <= 2; ++seed) patchedIsAtOnce({.seed = seed});
}

// Case in which the clearance radius of the rover exceeds the radius of the footprint.
TEST(MapSurface, PatchedEqualsFullBuildWithSmallFootprint) {
  patchedIsAtOnce({.seed = 41,
                   .resolution_m = 0.05,
                   .footprint_m = 0.1,
                   .rounds = 12,
                   .most_drives = 0,
                   .policy = {.pose_error_m = 0.0}});
}

TEST(MapSurface, PatchedEqualsFullBuildWithCurveOverflow) {
  for (unsigned seed = 31; seed <= 31; ++seed) patchedIsAtOnce({.seed = seed, .most_drives = 100});
}

TEST(MapSurface, PatchedEqualsFullBuildOnFourThreads) {
  for (unsigned seed = 11; seed <= 11; ++seed) patchedIsAtOnce({.seed = seed, .threads = 4});
}

TEST(MapSurface, PatchedEqualsFullBuildWithUnknownAllowed) {
  for (unsigned seed = 21; seed <= 21; ++seed)
    patchedIsAtOnce({.seed = seed, .policy = {.allow_unknown = true}});
}

// Property: a strip of two metres without data has the slope between the known heights on both sides, and is
// allowed if that slope is within the limits.
TEST(MapSurface, OpenedUnseenCellsUseTheSlopeBetweenKnownHeights) {
  for (const double fall_m : {0.2, 5.0}) {
    MapLayers layers;
    layers.elevation.elevation_m =
        maps::Raster<float>({.width = 40, .height = 40, .resolution_m = 0.5, .south_west = {}}, 0.0F);
    for (int row = 0; row < 40; ++row)
      for (int column = 18; column < 40; ++column)
        layers.elevation.elevation_m[{column, row}] = column < 22 ? kNaN : static_cast<float>(-fall_m);
    const TraversabilityMap map(std::move(layers), testGround({.allow_unknown = true}), {});
    const auto grid = map.published();
    for (int column = 18; column < 22; ++column) {
      const CellCode code = grid->at({column, 20});
      EXPECT_EQ(code.curve() == CellCode::kBlocked, fall_m > 1.0) << column;
      // Closed form: the known heights are five cells of half a metre apart. Tolerance: half a step.
      if (fall_m < 1.0) {
        EXPECT_NEAR(code.dzDx(), -fall_m / 2.5, 0.5 * CellCode::kStep);
      }
    }
  }
}

}  // namespace map_surface_test
}  // namespace talus::costmap
