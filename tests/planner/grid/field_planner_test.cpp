#include <cmath>
#include <stop_token>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>

#include "contour_plane.hpp"
#include "drawn_map.hpp"

namespace talus::planner {
namespace field_planner_test {

using testing::drawn;
using ::testing::HasSubstr;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

Problem problem(MapPointer map, maps::Point start, maps::Point goal) {
  Problem made;
  made.map = std::move(map);
  made.start = start;
  made.goal = goal;
  return made;
}

TEST(FieldPlanner, FailureNamesItsReason) {
  const auto map = drawn({"..#..", "..#..", "..#?."});
  FieldPlanner planner;
  const Plan walled = planner.plan(problem(map, {0.5, 0.5}, {4.5, 1.5}));
  EXPECT_EQ(walled.status, RouteStatus::NoRoute);
  EXPECT_THAT(
      walled.reason,
      HasSubstr(
          "6 cells are reachable from the start, 5 lead to the goal; closest at 1.50,0.50 and 3.50,1.50"));
  const Plan on_wall = planner.plan(problem(map, {2.5, 0.5}, {4.5, 1.5}));
  EXPECT_EQ(on_wall.status, RouteStatus::StartInvalid);
  EXPECT_THAT(on_wall.reason,
              HasSubstr("start 2.50,0.50 lies on a blocked cell; the nearest traversable cell is"));
  const Plan unseen = planner.plan(problem(map, {0.5, 0.5}, {3.5, 0.5}));
  EXPECT_EQ(unseen.status, RouteStatus::GoalInvalid);
  EXPECT_THAT(unseen.reason, HasSubstr("goal 3.50,0.50 lies on an unobserved cell"));
  const Plan outside = planner.plan(problem(map, {-3.0, 0.5}, {3.5, 0.5}));
  EXPECT_EQ(outside.status, RouteStatus::StartInvalid);
  EXPECT_THAT(outside.reason, HasSubstr("outside the map"));
}

// Planes on which only headings near the contour are allowed, at angles that are not among the grid's
// directions.
TEST(FieldPlanner, HeadingsBetweenGridDirectionsAreUsed) {
  for (int k = 0; k < 24; ++k) {
    const double contour = 0.2 + k * 0.2618;
    const auto map = testing::contourPlane(contour);
    FieldPlanner planner;
    const Plan plan =
        planner.plan(problem(map, {20.0 - 14.0 * std::cos(contour), 20.0 - 14.0 * std::sin(contour)},
                             {20.0 + 14.0 * std::cos(contour), 20.0 + 14.0 * std::sin(contour)}));
    ASSERT_EQ(plan.status, RouteStatus::Found) << contour << plan.reason;
    EXPECT_TRUE(violations(*map, plan.points).empty());
    EXPECT_LE(length_m(plan.points), 1.02 * 28.0);
  }
}

TEST(FieldPlanner, RouteEndsWithinToleranceOfABlockedGoal) {
  const auto map = drawn({".....", "...##", "...##"});
  FieldPlanner planner;
  auto asked = problem(map, {0.5, 0.5}, {4.5, 0.5});
  EXPECT_EQ(planner.plan(asked).status, RouteStatus::GoalInvalid);
  asked.goal_tolerance_m = 2.1;
  const Plan plan = planner.plan(asked);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_LE(std::hypot(plan.points.back().x_m - 4.5, plan.points.back().y_m - 0.5), 2.1);
}

TEST(FieldPlanner, RouteEndsAtTheToleranceCircle) {
  const auto map = drawn(std::vector<std::string>(10, std::string(40, '.')));
  FieldPlanner planner;
  auto asked = problem(map, {1.5, 5.5}, {35.5, 5.5});
  asked.goal_tolerance_m = 4.0;
  const Plan plan = planner.plan(asked);  // Closed form: 34 m less a tolerance of 4 m, at 10 J/m
  EXPECT_NEAR(plan.cost_J, 300.0, 1e-3);
  EXPECT_LE(plan.lower_bound_J, plan.cost_J);
  asked.goal_tolerance_m = 34.5;
  EXPECT_NEAR(planner.plan(asked).cost_J, 0.0, 1e-9);
}

TEST(FieldPlanner, RoutePassesViaPoints) {
  const auto map = drawn(std::vector<std::string>(20, std::string(20, '.')));
  FieldPlanner planner;
  auto asked = problem(map, {1.5, 1.5}, {18.5, 1.5});
  asked.via = {{10.5, 15.5}};
  const Plan plan = planner.plan(asked);
  ASSERT_EQ(plan.status, RouteStatus::Found);
  EXPECT_NE(std::find(plan.points.begin(), plan.points.end(), asked.via[0]), plan.points.end());
}

TEST(FieldPlanner, StartEqualToGoalCostsZero) {
  FieldPlanner planner;
  const Plan plan = planner.plan(problem(drawn({"...", "..."}), {1.2, 0.7}, {1.2, 0.7}));
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_NEAR(plan.cost_J, 0.0, 1e-9);
}

TEST(FieldPlanner, ResultIsIndependentOfThreadCountAndRepetition) {
  const auto map = randomMap({.width = 200, .height = 150, .seed = 12, .blocked = 0.1, .roughness = 0.15});
  auto asked = problem(map, {3.5, 4.5}, {190.1, 140.2});
  FieldPlanner one, two;
  const Plan first = one.plan(asked), again = one.plan(asked);
  asked.threads = 2;
  const Plan other = two.plan(asked);
  EXPECT_EQ(first.points, again.points);
  EXPECT_EQ(first.points, other.points);
}

// Property: after a patch changed, the retained field gives the same bytes as a new planner.
TEST(FieldPlanner, ReplanningEqualsPlanningAnew) {
  const auto map = randomMap({.width = 200, .height = 200, .seed = 3, .blocked = 0.05, .roughness = 0.15});
  auto asked = problem(map, {5.5, 5.5}, {190.5, 180.5});
  FieldPlanner kept;
  const Plan before = kept.plan(asked);
  ASSERT_EQ(before.status, RouteStatus::Found);
  auto content = map->content();
  auto tile = std::make_shared<costmap::CostTile>(*content.tiles[5]);
  for (auto& cell : tile->cells) cell = costmap::CellCode({.dz_dx = 0.0, .dz_dy = 0.0, .curve = 4});
  content.tiles.set(5, tile);
  asked.map = std::make_shared<costmap::CostGrid>(content);
  FieldPlanner fresh;
  const Plan after = kept.plan(asked), anew = fresh.plan(asked);
  EXPECT_EQ(after.points, anew.points);
  EXPECT_NE(after.points, before.points);
}

TEST(FieldPlanner, StopAndTimeLimitHaveTheirStatuses) {
  const auto map = randomMap({.width = 60, .height = 60, .blocked = 0.0});
  FieldPlanner planner;
  auto asked = problem(map, {1.5, 1.5}, {50.5, 50.5});
  std::stop_source source;
  source.request_stop();
  asked.watch.stop = source.get_token();
  EXPECT_EQ(planner.plan(asked).status, RouteStatus::Cancelled);
  asked.watch = {};
  asked.time_limit_s = 1e-9;
  EXPECT_EQ(planner.plan(asked).status, RouteStatus::TimedOut);
}

}  // namespace field_planner_test
}  // namespace talus::planner
