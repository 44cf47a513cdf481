#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
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
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

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
