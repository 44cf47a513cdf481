#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <utility>

#include <cost_bits.hpp>
#include <gmock/gmock.h>
#include <refused.hpp>
#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace traversability_map_test {

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
SurfacePatch randomPatch(std::mt19937& random, const maps::Grid& grid) {
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
    const SurfacePatch patch = randomPatch(random, grid);
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

using testing::HasSubstr;

// Elevation of a site far larger than any window.
float heightAt(maps::Point p) {
  return static_cast<float>(0.5 * std::sin(0.3 * p.x_m) * std::cos(0.2 * p.y_m));
}

maps::Grid window(Cell tiles) {
  return {.width = 150,
          .height = 130,
          .resolution_m = 0.5,
          .south_west = {32.0 * tiles.column, 32.0 * tiles.row}};
}

// Layers of a window of the site, with data in `seen` only.
MapLayers layersOf(const maps::Grid& grid, const maps::Grid& seen) {
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid, kNaN);
  layers.classes = maps::Raster<std::uint8_t>(grid, 255);
  layers.keep_out = maps::Raster<std::uint8_t>(grid, 0);
  layers.costs = {{"own", maps::Raster<float>(grid, kNaN), 30.0F}};
  forEachCell(allOf(grid), [&](Cell c) {
    const maps::Point p = grid.centre(c);
    if (!seen.cellAt(p)) return;
    layers.elevation.elevation_m[c] = heightAt(p);
    layers.classes[c] = std::fmod(p.x_m + 1000.0, 20.0) < 10.0 ? 1 : 2;
    layers.keep_out[c] = std::fmod(p.y_m + 1000.0, 17.0) < 0.5 ? 1 : 0;
    layers.costs[0].added_J_per_m[c] = std::fmod(p.x_m + 1000.0, 9.0) < 2.0 ? 20.0F : 0.0F;
  });
  return layers;
}

// Property: after moves, drives, a refusal and new data the map is bit-identical to a map built from the same
// layers and the remaining evidence.
TEST(MapMove, MovedMapEqualsARebuiltMap) {
  std::mt19937 random(3);
  for (const Cell tiles : {Cell{1, 0}, Cell{0, -1}, Cell{-1, 1}, Cell{2, 0}}) {
    const maps::Grid before = window({0, 0}), after = window(tiles);
    TraversabilityMap map(layersOf(before, before), testGround(), {});
    for (int k = 0; k < 4; ++k) {
      WheelObservation seen;
      seen.place = {uniform(random, 0.0, 75.0), uniform(random, 0.0, 65.0)};
      seen.pull = {uniform(random, 0.05, 0.4), 0.05};
      seen.sinkage = {uniform(random, 0.05, 0.4), 0.05};
      map.learn(seen);
    }
    const maps::Point stuck = before.centre({100, 30});
    map.refuse(stuck, 1.5);
    map.publishAll();
    const TraversabilityMap moved = map.moved(tiles);
    EXPECT_EQ(moved.grid(), after);
    EXPECT_EQ(moved.published()->version(), map.published()->version() + 1);
    TraversabilityMap at_once(layersOf(after, before), testGround(), {});
    moved.evidence().visit([&](const SavedBlock& block) { ASSERT_TRUE(at_once.restore(block)); });
    at_once.refuse(stuck, 1.5);
    at_once.publishAll();
    forEachCell(allOf(after), [&](Cell c) {
      ASSERT_EQ(moved.surface().hazards(c), at_once.surface().hazards(c)) << c.column << ' ' << c.row;
      ASSERT_EQ(moved.belief(c), at_once.belief(c)) << c.column << ' ' << c.row;
      ASSERT_EQ(costBits(*moved.published(), c), costBits(*at_once.published(), c))
          << c.column << ' ' << c.row;
    });
    // Evidence of a place in both windows is retained.
    std::size_t blocks = 0;
    moved.evidence().visit([&](const SavedBlock&) { ++blocks; });
    forEachCell(allOf(after), [&](Cell c) {
      const auto old = before.cellAt(after.centre(c));
      if (old) {
        ASSERT_EQ(moved.belief(c).evidence, map.belief(*old).evidence);
      } else {
        ASSERT_TRUE(has(moved.surface().hazards(c), Hazard::Unknown));
      }
    });
    EXPECT_GT(blocks, 0U);
  }
}

TEST(MapMove, MovingBackDoesNotRestoreDroppedCells) {
  const maps::Grid grid = window({0, 0});
  const TraversabilityMap map(layersOf(grid, grid), testGround(), {});
  const TraversabilityMap back = map.moved({1, 0}).moved({-1, 0});
  EXPECT_EQ(back.grid(), grid);
  EXPECT_TRUE(std::isnan(back.elevation().elevation_m[{10, 10}]));
  EXPECT_EQ(back.elevation().elevation_m[Cell(100, 10)], map.elevation().elevation_m[Cell(100, 10)]);
}

TEST(MapMove, MoveWithoutOverlapIsRejected) {
  const maps::Grid grid = window({0, 0});
  const TraversabilityMap map(layersOf(grid, grid), testGround(), {});
  for (const Cell tiles : {Cell{3, 0}, Cell{0, -3}, Cell{2000000000, 0}, Cell{0, -2147483647}}) {
    try {
      map.moved(tiles);
      ADD_FAILURE() << tiles.column << ' ' << tiles.row;
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), HasSubstr("leaves nothing of the map of 150 x 130 cells"));
    }
  }
}

using terramech::Category;

const std::vector<std::string> kSite{
    "11111222", "11111222", "11?11222", "11111#22", "11111122", "30111122",
};

Category categoryOf(const TraversabilityMap& map, maps::Cell cell) {
  return static_cast<Category>(map.belief(cell).category);
}

TEST(TraversabilityMap, CategoriesAndHazardsMatchTheTestSite) {
  const TraversabilityMap map = mapOf(kSite);
  EXPECT_EQ(categoryOf(map, {3, 1}), Category::Safe);
  EXPECT_EQ(categoryOf(map, {2, 3}), Category::Unknown);
  EXPECT_TRUE(has(map.surface().hazards({0, 5}), Hazard::Near)) << "beside the edge of the map";
  EXPECT_TRUE(has(map.surface().hazards({5, 2}), Hazard::KeepOut));
  EXPECT_TRUE(has(map.surface().hazards({0, 0}), Hazard::Obstacle)) << "class 3 has no soil";
  EXPECT_TRUE(has(map.surface().hazards({1, 0}), Hazard::Obstacle)) << "class 0 has no soil";
  EXPECT_GT(map.belief({3, 1}).pull_mean, map.belief({6, 4}).pull_mean) << "sand pulls better than dust";
}

TEST(TraversabilityMap, PublishedCostsMatchTheBeliefs) {
  const TraversabilityMap map = mapOf(kSite);
  const auto grid = map.published();
  EXPECT_EQ(grid->version(), 1U);
  EXPECT_EQ(grid->at({2, 3}).curve(), CellCode::kUnknown);
  EXPECT_EQ(grid->at({5, 2}).curve(), CellCode::kBlocked);
  EXPECT_TRUE(std::isfinite(grid->cost().costPerMetre(grid->at({3, 1}), {})));
  EXPECT_LT(grid->cost().costPerMetre(grid->at({3, 1}), {}), grid->cost().costPerMetre(grid->at({6, 4}), {}));
}

TEST(TraversabilityMap, LayersOnAnotherGridAreRejected) {
  MapLayers layers = drawn(kSite);
  layers.classes =
      maps::Raster<std::uint8_t>(maps::Grid{.width = 2, .height = 2, .resolution_m = 1.0, .south_west = {}});
  EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                 "classes lies on another grid than the elevation");
}

TEST(TraversabilityMap, UnknownIsTraversableOnlyOnRequest) {
  const TraversabilityMap map = mapOf(kSite, 0.0, {.allow_unknown = true});
  const auto grid = map.published();
  EXPECT_TRUE(std::isfinite(grid->cost().costPerMetre(grid->at({2, 3}), {})));
}

TEST(TraversabilityMap, ResultIsIndependentOfBandsAndThreads) {
  // Property: 600 rows are three bands; the metrics equal those of the whole raster for any number of
  // threads.
  const maps::Grid grid{.width = 40, .height = 600, .resolution_m = 0.5, .south_west = {}};
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(0.3 * std::sin(0.1 * row) * std::cos(0.2 * column));
  const auto whole = maps::terrainMetrics(layers.elevation.elevation_m, {.radius_m = 0.5, .threads = 1});
  const TraversabilityMap one(layers, testGround(), {.footprint_radius_m = 0.5, .threads = 1});
  const TraversabilityMap two(layers, testGround(), {.footprint_radius_m = 0.5, .threads = 2});
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const maps::Cell cell{column, row};
      ASSERT_EQ(one.published()->at(cell), two.published()->at(cell));
      const CellCode expected({.dz_dx = static_cast<double>(whole.dz_dx[cell]),
                               .dz_dy = static_cast<double>(whole.dz_dy[cell]),
                               .curve = one.published()->at(cell).curve()});
      ASSERT_EQ(one.published()->at(cell), expected) << column << ' ' << row;
    }
}

// Property: while versions are published, a reader on another thread sees only complete versions (cells
// refused together appear together), never an older version after a newer one; a version in use by the reader
// does not change.
TEST(TraversabilityMap, ConcurrentReadersObserveConsistentVersionsInOrder) {
  TraversabilityMap map = mapOf(std::vector<std::string>(20, std::string(300, '1')));
  const auto refused = [](const CostGrid& grid, int column) {
    return grid.at({column, 10}).curve() == CellCode::kBlocked;
  };
  std::atomic<bool> done{false};
  std::atomic<int> torn{0}, backwards{0}, changed{0};
  const auto read = [&] {
    std::uint64_t newest = 0;
    while (!done) {
      const auto grid = map.published();
      if (grid->version() < newest) ++backwards;
      newest = grid->version();
      std::array<bool, 100> before{};
      for (int i = 0; i < 100; ++i) {
        before[static_cast<std::size_t>(i)] = refused(*grid, i);
        if (before[static_cast<std::size_t>(i)] != refused(*grid, 299 - i)) ++torn;
      }
      for (int i = 0; i < 100; ++i)
        if (refused(*grid, i) != before[static_cast<std::size_t>(i)]) ++changed;
    }
  };
  {
    std::jthread first(read), second(read);
    for (int i = 0; i < 100; ++i) {
      map.refuse(map.grid().centre({i, 10}), 0.1);
      map.refuse(map.grid().centre({299 - i, 10}), 0.1);
      map.publish();
    }
    done = true;
  }
  EXPECT_EQ(map.published()->version(), 101U);
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
  EXPECT_EQ(changed, 0);
}

}  // namespace traversability_map_test
}  // namespace talus::costmap
