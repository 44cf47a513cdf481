#include <algorithm>
#include <cmath>
#include <queue>
#include <random>
#include <set>
#include <stop_token>

#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace cost_to_go_test {

constexpr auto kAlways = [](std::uint64_t) { return true; };

// Property: keys within range are returned bucket by bucket, in insertion order within a bucket, also keys
// queued during the processing. The ring is small, so that it wraps many times.
TEST(BucketQueue, KeysWithinRangeAreInBucketOrder) {
  for (const unsigned shift : {0U, 3U, 5U}) {
    std::mt19937 random(shift + 1);
    std::vector<std::uint64_t> keys{17};  // by index
    BucketQueue queue(shift, 100);
    queue.startAt(keys[0]);
    queue.push(keys[0], 0);
    std::vector<std::uint32_t> taken;
    queue.run(
        [&](std::uint32_t index) {
          taken.push_back(index);
          EXPECT_EQ(queue.bucketOf(keys[index]), queue.current());
          for (int k = 0; k < 2 && keys.size() < 5'000; ++k) {
            keys.push_back(keys[index] + random() % 101);
            queue.push(keys.back(), static_cast<std::uint32_t>(keys.size() - 1));
          }
        },
        kAlways);
    ASSERT_EQ(taken.size(), keys.size());
    // The index counts insertions, so that insertion order within a bucket is the order of the index.
    EXPECT_TRUE(std::ranges::is_sorted(
        taken, {}, [&](std::uint32_t index) { return std::pair(queue.bucketOf(keys[index]), index); }));
  }
}

TEST(BucketQueue, PastKeysAreReturnedAtOnceAndDistantKeysAtTheLastBucket) {
  BucketQueue queue(0, 6);  // a ring of 8 buckets
  queue.startAt(50);
  queue.push(50, 0);
  std::vector<std::pair<std::uint32_t, std::uint64_t>> taken;  // index and bucket
  queue.run(
      [&](std::uint32_t index) {
        taken.emplace_back(index, queue.current());
        if (index != 0) return;
        queue.push(1'000, 1);
        queue.push(3, 2);
      },
      kAlways);
  // Closed form: 50 + 8 - 1 is the last bucket of the ring.
  EXPECT_EQ(taken, (std::vector<std::pair<std::uint32_t, std::uint64_t>>{{0, 50}, {2, 50}, {1, 57}}));
}

TEST(BucketQueue, RunPausesAndResumes) {
  BucketQueue queue(2, 40);
  for (const std::uint32_t key : {0U, 9U, 21U}) queue.push(key, key);
  std::vector<std::uint32_t> taken;
  const auto take = [&](std::uint32_t index) { taken.push_back(index); };
  queue.run(take, [](std::uint64_t first) { return first < 12; });
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{0, 9}));
  queue.run(take, kAlways);
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{0, 9, 21}));
}

using testing::drawn;
using testing::randomMap;

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

std::shared_ptr<const EdgeLayer> edgesOf(const MapPointer& map, int threads = 1) {
  return std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), map->grid().resolution_m), threads);
}

// Dijkstra with a plain priority queue; an edge is the exact cost of the segment between two centres.
maps::Raster<double> bruteForce(const MapPointer& map, maps::Cell goal) {
  const MotionCost cost(map);
  const maps::Grid& grid = map->grid();
  maps::Raster<double> best(grid, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[goal] = 0.0;
  open.emplace(0.0, grid.index(goal));
  while (!open.empty()) {
    const auto [value, index] = open.top();
    open.pop();
    const maps::Cell cell{static_cast<int>(index) % grid.width, static_cast<int>(index) / grid.width};
    if (value > best[cell]) continue;
    for (const maps::Cell step : kStep) {
      const maps::Cell from{cell.column + step.column, cell.row + step.row};
      if (!grid.contains(from)) continue;
      const double through = value + cost({grid.centre(from), grid.centre(cell)});
      if (!(through < best[from])) continue;
      best[from] = through;
      open.emplace(through, grid.index(from));
    }
  }
  return best;
}

// Property: the field equals that of Dijkstra's algorithm. Each edge is rounded by at most one unit; the
// cheapest edge has 512 units.
TEST(CostToGo, MatchesDijkstraOnRandomMaps) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto map = randomMap({.width = 23, .height = 17, .seed = seed, .blocked = 0.25, .roughness = 0.35});
    const maps::Cell goal{static_cast<int>(seed % 23), static_cast<int>(seed % 17)};
    const auto expected = bruteForce(map, goal);
    CostToGo field(edgesOf(map), {{.cell = goal}});
    ASSERT_TRUE(field.settleAll());
    for (int row = 0; row < 17; ++row)
      for (int column = 0; column < 23; ++column) {
        const maps::Cell cell{column, row};
        const auto found = field.cost_J(cell);
        ASSERT_EQ(found.has_value(), std::isfinite(expected[cell])) << seed << ": " << column << "," << row;
        if (found) {
          ASSERT_NEAR(*found, expected[cell], 1e-9 + expected[cell] / 512);
        }
      }
  }
}

TEST(CostToGo, SearchResumesAfterSettlingACell) {
  const auto map = randomMap({.width = 60, .height = 50, .seed = 5});
  CostToGo whole(edgesOf(map), {{.cell = {3, 4}}}), parts(edgesOf(map), {{.cell = {3, 4}}});
  ASSERT_TRUE(whole.settleAll());
  ASSERT_TRUE(parts.settle({10, 10}));
  EXPECT_LT(parts.settled(), whole.settled());
  EXPECT_EQ(parts.units({10, 10}), whole.units({10, 10}));
  ASSERT_TRUE(parts.settleAll());
  for (int row = 0; row < 50; ++row)
    for (int column = 0; column < 60; ++column)
      ASSERT_EQ(parts.units({column, row}), whole.units({column, row}));
}

TEST(CostToGo, FieldOfSeveralGoalsIsTheMinimum) {
  const auto edges = edgesOf(randomMap({.seed = 8}));
  CostToGo one(edges, {{.cell = {2, 2}}}), other(edges, {{.cell = {17, 15}}}),
      both(edges, {{.cell = {2, 2}}, {.cell = {17, 15}}});
  ASSERT_TRUE(one.settleAll() && other.settleAll() && both.settleAll());
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) {
      const maps::Cell cell{column, row};
      EXPECT_EQ(both.units(cell), std::min(one.units(cell), other.units(cell)));
    }
}

TEST(CostToGo, StopsOnRequest) {
  const auto edges = edgesOf(randomMap({.width = 50, .height = 50}));
  CostToGo field(edges, {{.cell = {5, 5}}});
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(field.settleAll(ProgressMonitor{.progress = {}, .stop = source.get_token()}));
  EXPECT_TRUE(field.settleAll());
}

// Property: vector and scalar kernels give bit-identical edges and fields.
TEST(CostToGo, VectorAndScalarKernelsAreIdentical) {
  const auto map = randomMap({.width = 83, .height = 71, .seed = 6, .blocked = 0.2, .roughness = 0.4});
  const EdgeUnits units(map->cost(), 1.0);
  const auto best = std::make_shared<EdgeLayer>(map, units);
  const auto scalar = std::make_shared<EdgeLayer>(map, units, 1, StopCheck{}, Kernels::Scalar);
  for (std::size_t i = 0; i < best->padded().size(); ++i)
    for (int k = 0; k < 8; ++k) ASSERT_EQ(best->into(i)[k], scalar->into(i)[k]) << i << " " << k;
  CostToGo one(best, {{.cell = {40, 30}}}), other(best, {{.cell = {40, 30}}}, Kernels::Scalar);
  ASSERT_TRUE(one.settleAll() && other.settleAll());
  for (int row = 0; row < 71; ++row)
    for (int column = 0; column < 83; ++column)
      ASSERT_EQ(one.units({column, row}), other.units({column, row}));
}

// Property: for any change of a patch, with a complete or partial field, the repaired field equals the
// recomputed field.
TEST(CostToGo, RepairEqualsRecomputation) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&random](unsigned limit) { return static_cast<int>(random() % limit); };
    const auto map = randomMap({.width = 70, .height = 60, .seed = seed, .blocked = 0.2});
    maps::Raster<costmap::CellCode> cells(map->grid());
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 70; ++column) cells[{column, row}] = map->at({column, row});
    const EdgeUnits units(map->cost(), 1.0);
    const auto edges = std::make_shared<EdgeLayer>(map, units);
    const FieldGoal goal{.cell = {below(70), below(60)}};
    const maps::Cell until{below(70), below(60)};
    CostToGo field(edges, {goal});
    ASSERT_TRUE(seed % 2 == 0 ? field.settle(until) : field.settleAll());
    for (int round = 0; round < 4; ++round) {
      const maps::Cell first{below(60), below(50)};
      const CellBox box{first, {first.column + below(10), first.row + below(10)}};
      for (int row = box.first.row; row <= box.last.row; ++row)
        for (int column = box.first.column; column <= box.last.column; ++column)
          cells[{column, row}] =
              costmap::CellCode({.dz_dx = 0.004 * below(100) - 0.2,
                                 .dz_dy = 0.1,
                                 .curve = static_cast<std::uint8_t>(below(3) == 0 ? 255 : below(5))});
      const auto newer = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, map->content().cost));
      edges->update(newer, units, box);
      field.repair(box);
      CostToGo anew(std::make_shared<EdgeLayer>(newer, units), {goal});
      ASSERT_TRUE(field.settle(until) && anew.settle(until));
      ASSERT_EQ(field.units(until), anew.units(until)) << seed;
      if (seed % 2 == 0 && round < 3) continue;
      ASSERT_TRUE(field.settleAll() && anew.settleAll());
      for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 70; ++column)
          ASSERT_EQ(field.units({column, row}), anew.units({column, row}))
              << seed << ": " << column << "," << row;
    }
  }
}

// Property: links are all cells whose centre is at most one cell away in column and row and that the exact
// motion reaches, at its cost; the cost there and that back are separate.
TEST(GridLinks, LinksAreTheAllowedMotionsToNeighbours) {
  int found = 0, uneven = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const MotionCost cost(randomMap({.width = 9, .height = 7, .seed = seed, .roughness = 0.4}));
    const maps::Grid& grid = cost.map().grid();
    for (const maps::Point place : {maps::Point{4.3, 3.6}, {0.1, 6.9}, {8.9, 0.2}, {3.0, 2.5}}) {
      const auto from = linksFrom(cost, place), to = linksTo(cost, place);
      std::size_t expected_from = 0, expected_to = 0;
      const maps::Cell own = *grid.cellAt(place);
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 9; ++column) {
          if (std::abs(row - own.row) > 1 || std::abs(column - own.column) > 1) continue;
          const maps::Point centre = grid.centre({column, row});
          expected_from += std::isfinite(cost({place, centre}));
          expected_to += std::isfinite(cost({centre, place}));
        }
      ASSERT_EQ(from.size(), expected_from);
      ASSERT_EQ(to.size(), expected_to);
      for (const GridLink& link : from) EXPECT_EQ(link.cost_J, cost({place, grid.centre(link.cell)}));
      for (const GridLink& link : to) EXPECT_EQ(link.cost_J, cost({grid.centre(link.cell), place}));
      found += static_cast<int>(from.size());
      uneven += !from.empty() && !to.empty() && from[0].cost_J != to[0].cost_J;
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(uneven, 5);
}

TEST(GridLinks, PlacesOutsideTheMapHaveNoLinks) {
  const MotionCost cost(drawn({"...", "..."}));
  EXPECT_TRUE(linksFrom(cost, {-0.1, 0.5}).empty());
  EXPECT_TRUE(linksTo(cost, {1.5, 2.0}).empty());
}

// Property: the goal cells, with cost 0, are all cells whose centres lie in the circle, also around a goal
// off the map; by brute force.
TEST(GridLinks, GoalCellsAreAllAllowedCellsWithinTolerance) {
  const auto map = randomMap({.width = 25, .height = 19, .seed = 3, .blocked = 0.3});
  const MotionCost cost(map);
  for (const maps::Point goal : {maps::Point{12.2, 9.9}, {0.5, 0.5}, {24.9, 18.9}, {-2.0, 10.0}})
    for (const double tolerance_m : {0.0, 0.6, 3.0, 7.7}) {
      std::set<std::pair<int, int>> expected, found;
      for (int row = 0; row < 19; ++row)
        for (int column = 0; column < 25; ++column) {
          const maps::Point centre = map->grid().centre({column, row});
          const double away_m = std::hypot(centre.x_m - goal.x_m, centre.y_m - goal.y_m);
          if (tolerance_m > 0.0 && away_m <= tolerance_m && cost.allowed(centre))
            expected.emplace(column, row);
        }
      const auto goals = fieldGoals(cost, goal, tolerance_m);
      const std::size_t links = linksTo(cost, goal).size();
      ASSERT_GE(goals.size(), links);
      for (std::size_t k = links; k < goals.size(); ++k) {
        EXPECT_EQ(goals[k].cost_J, 0.0);
        found.emplace(goals[k].cell.column, goals[k].cell.row);
      }
      EXPECT_EQ(found, expected) << goal.x_m << " " << tolerance_m;
    }
}

}  // namespace cost_to_go_test

}  // namespace talus::planner
