#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <site_map.hpp>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>

namespace talus::costmap {
namespace map_move_test {

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

std::array<std::uint32_t, 16> costs(const CostGrid& grid, Cell cell) {
  std::array<std::uint32_t, 16> bits{};
  for (std::size_t k = 0; k < bits.size(); ++k) {
    const double heading = 0.3926990817 * static_cast<double>(k);
    bits[k] = std::bit_cast<std::uint32_t>(
        grid.cost().costPerMetre(grid.at(cell), {std::cos(heading), std::sin(heading)}));
  }
  return bits;
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
      ASSERT_EQ(costs(*moved.published(), c), costs(*at_once.published(), c)) << c.column << ' ' << c.row;
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

}  // namespace map_move_test
}  // namespace talus::costmap
