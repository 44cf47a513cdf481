#include <cmath>
#include <queue>
#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cost_to_go_test {

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

TEST(CostToGo, PathLeadsFromStartToGoalOverAllowedEdges) {
  const auto map = drawn({".....", ".###.", "...#.", "####.", "....."});
  CostToGo field(edgesOf(map), {{.cell = {0, 0}}});
  ASSERT_TRUE(field.settleAll());
  const auto path = field.path({0, 2});
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(path.front(), (maps::Cell{0, 2}));
  EXPECT_EQ(path.back(), (maps::Cell{0, 0}));
  const MotionCost cost(map);
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += cost({map->grid().centre(path[i - 1]), map->grid().centre(path[i])});
  EXPECT_NEAR(sum, *field.cost_J({0, 2}), 0.002 * sum);
}

TEST(CostToGo, UnreachableCellHasNoCostAndNoPath) {
  CostToGo field(edgesOf(drawn({"..#..", "..#..", "..#.."})), {{.cell = {0, 0}}});
  ASSERT_TRUE(field.settleAll());
  EXPECT_FALSE(field.cost_J({4, 1}));
  EXPECT_TRUE(field.path({4, 1}).empty());
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

}  // namespace cost_to_go_test
}  // namespace talus::planner
