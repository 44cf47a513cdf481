#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include <refused.hpp>
#include <site_map.hpp>

#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {
namespace traversability_map_test {

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

TEST(TraversabilityMap, ClimbingCostsMoreThanDescending) {
  const TraversabilityMap map = mapOf({8, "11111111"}, 0.08);
  const auto grid = map.published();
  const CellCode cell = grid->at({4, 4});
  EXPECT_NEAR(cell.dzDx(), 0.08, 1.0 / 1024.0);  // Closed form: the plane, to a step of the cell code
  EXPECT_GT(grid->cost().costPerMetre(cell, {1, 0}), grid->cost().costPerMetre(cell, {-1, 0}));
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
