#include <cmath>
#include <stop_token>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>

#include "drawn_map.hpp"

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

TEST(Remedy, InvalidPlaceNamesItsFaultAndTheNearestTraversableCell) {
  const auto map = drawn({"..#?.", "..##."});
  EXPECT_EQ(invalidPlace(*map, "start", {2.6, 0.5}),
            "start 2.60,0.50 lies on a blocked cell; the nearest traversable cell is 1.50,0.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {3.9, 1.5}),
            "goal 3.90,1.50 lies on an unobserved cell; the nearest traversable cell is 4.50,1.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {9.0, 0.5}),
            "goal 9.00,0.50 lies outside the map; the nearest traversable cell is 4.50,0.50");
}

// Property: the message names the hazard in the cell, the hazard whose clearance covers the cell, or the
// rim, and offers a cell that is connected to the other end.
TEST(Remedy, InvalidPlaceNamesItsHazard) {
  using costmap::Hazard;
  const auto map = drawn({"######", "#..#.#", "#....#", "######"});
  const auto rocks = [](maps::Cell c) { return c == maps::Cell{3, 2} ? Hazard::Rocks : Hazard::Near; };
  EXPECT_EQ(invalidPlace(*map, "start", {3.5, 2.5}, {.hazards = rocks}),
            "start 3.50,2.50 lies on a blocked cell: rocks; the nearest traversable cell is 3.50,1.50");
  EXPECT_THAT(invalidPlace(*map, "start", {0.5, 0.5}, {.hazards = rocks}),
              ::testing::HasSubstr("too near to the rim of the map"));
  EXPECT_THAT(invalidPlace(*map, "goal", {4.5, 3.2}, {.hazards = rocks}),
              ::testing::HasSubstr("too near to rocks"));
  const auto west = [](maps::Cell c) { return c.column < 2; };
  EXPECT_EQ(invalidPlace(*map, "start", {3.5, 2.5}, {.hazards = rocks, .joined = west}),
            "start 3.50,2.50 lies on a blocked cell: rocks; the nearest traversable cell is 1.50,2.50, from "
            "which the goal "
            "can be reached");
}

TEST(Remedy, GoalIsValidWithinItsTolerance) {
  const MotionCost cost(drawn({"..#..", "..#.."}));
  EXPECT_TRUE(mayEnd(cost, {1.5, 0.5}, 0.0));
  EXPECT_FALSE(mayEnd(cost, {2.5, 0.5}, 0.4));
  EXPECT_TRUE(mayEnd(cost, {2.5, 0.5}, 0.6));
}

}  // namespace grid_route_test

}  // namespace talus::planner
