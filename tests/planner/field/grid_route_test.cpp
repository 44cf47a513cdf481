#include <cmath>
#include <stop_token>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>

#include "changed_map.hpp"

namespace talus::planner {
namespace grid_route_test {

using testing::drawn;
using testing::randomMap;

std::shared_ptr<EdgeLayer> edgesOf(const std::shared_ptr<const costmap::CostGrid>& map) {
  return std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0));
}

Polyline routed(const MotionCost& cost, const Segment& places) {
  CostToGo field(edgesOf(std::make_shared<costmap::CostGrid>(cost.map())), fieldGoals(cost, places.to, 0.0));
  return gridRoute(cost, field, places);
}

// Closed form: around a wall of two cells, along centres: 2 east, 2 diagonally up and 2 down.
TEST(GridRoute, RouteFollowsCellCentres) {
  const MotionCost cost(drawn({".......", ".......", "...#...", "...#..."}));
  const Polyline route = routed(cost, {{0.5, 1.5}, {6.5, 1.5}});
  EXPECT_EQ(route.front(), (maps::Point{0.5, 1.5}));
  EXPECT_EQ(route.back(), (maps::Point{6.5, 1.5}));
  EXPECT_NEAR(cost.along(route), 10.0 * (4 + 2 * std::sqrt(2.0)), 1e-4);
}

TEST(GridRoute, BlockedOrStoppedSearchYieldsNoRoute) {
  const MotionCost walled(drawn({"..#..", "..#.."})), open(drawn({".....", "....."}));
  EXPECT_TRUE(routed(walled, {{0.5, 0.5}, {4.5, 0.5}}).empty());
  EXPECT_TRUE(routed(walled, {{2.5, 0.5}, {4.5, 0.5}}).empty());  // begins on the wall
  std::stop_source source;
  source.request_stop();
  const Segment places{{0.5, 0.5}, {4.5, 0.5}};
  CostToGo field(edgesOf(drawn({".....", "....."})), fieldGoals(open, places.to, 0.0));
  EXPECT_TRUE(
      gridRoute(open, field, places, ProgressMonitor{.progress = {}, .stop = source.get_token()}).empty());
}

// Property: the route from the patched field is identical, point for point, to that from the recomputed
// field.
TEST(GridRoute, PatchedFieldRouteEqualsThatOfTheNewField) {
  int compared = 0, moved = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    testing::Below below(seed);
    const auto map = randomMap({.width = 70, .height = 60, .seed = seed, .blocked = 0.1, .roughness = 0.15});
    const maps::Cell first{20 + below(30), 15 + below(30)};
    const CellBox box{first, {first.column + below(9), first.row + below(9)}};
    const auto newer = testing::changed(map, box, testing::Change::Either, below);
    const Segment places{{3.3, 4.1}, {66.2, 55.7}};
    const MotionCost before(map), after(newer);
    const auto goals = fieldGoals(before, places.to, 0.0);  // the goal's cells lie outside the box
    const auto edges = edgesOf(map);
    CostToGo field(edges, goals), anew(edgesOf(newer), goals);
    const Polyline old = gridRoute(before, field, places);
    edges->update(newer, edges->units(), box);
    const auto patched = gridRouteAfter(box, after, field, places);
    if (!patched) continue;
    ++compared;
    EXPECT_EQ(*patched, gridRoute(after, anew, places)) << seed;
    moved += *patched != old;
  }
  EXPECT_GT(compared, 20);
  EXPECT_GT(moved, 2);
}

}  // namespace grid_route_test
}  // namespace talus::planner
