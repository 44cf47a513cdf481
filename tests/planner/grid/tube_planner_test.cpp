#include <cmath>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/tube_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace tube_planner_test {

using testing::drawn;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

MapPointer rough(unsigned seed) {
  return randomMap({.width = 320, .height = 300, .seed = seed, .blocked = 0.05, .roughness = 0.12});
}

// Property: the route is allowed, passes every via point, and costs at most 3 % more than that of the full
// field.
TEST(TubePlanner, CostIsWithinThreePercentOfTheFullField) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Problem problem{.map = rough(seed),
                          .start = {10.5, 12.5},
                          .goal = {300.5, 280.5},
                          .via = {{250.5, 40.5}},
                          .prove = false};
    const Plan whole = FieldPlanner().plan(problem), tube = TubePlanner().plan(problem);
    ASSERT_EQ(tube.status, whole.status) << seed << tube.reason;
    if (tube.status != RouteStatus::Found) continue;
    EXPECT_TRUE(violations(*problem.map, tube.points).empty());
    EXPECT_LT(tube.cost_J, 1.03 * whole.cost_J) << seed;
    EXPECT_GT(tube.cost_J, 0.97 * whole.cost_J) << seed;
    EXPECT_LE(tube.lower_bound_J, tube.cost_J);
    EXPECT_NE(std::find(tube.points.begin(), tube.points.end(), problem.via[0]), tube.points.end());
  }
}

// Property: the result is byte-identical with two threads, and after a change identical to that of a new
// planner.
TEST(TubePlanner, ResultIsIndependentOfThreadCountAndReplanning) {
  const MapPointer map = rough(3);
  Problem problem{.map = map, .start = {10.5, 12.5}, .goal = {300.5, 280.5}, .prove = false};
  TubePlanner planner;
  const Plan first = planner.plan(problem);
  ASSERT_EQ(first.status, RouteStatus::Found);
  const maps::Point middle = first.points[first.points.size() / 2];
  const maps::Cell at = *map->grid().cellAt(middle);
  const costmap::Revision revision{
      .ranges = {{{at.column - 20, at.row - 20}, {at.column + 20, at.row + 20}}},
      .code = [](maps::Cell, costmap::CellCode code) { return code.withCurve(4); },
      .cost = [&] { return map->content().cost; }};
  problem.map = std::make_shared<costmap::CostGrid>(costmap::revised(*map, revision));
  const Plan again = planner.plan(problem), anew = TubePlanner().plan(problem);
  EXPECT_EQ(again.points, anew.points);
  EXPECT_NE(again.points, first.points);
  problem.threads = 2;
  EXPECT_EQ(TubePlanner().plan(problem).points, anew.points);
}

// A gap that the pooled map does not show is found by the full field. Without a gap the full field proves
// that no route exists.
TEST(TubePlanner, FullFieldIsUsedIfThePooledMapHasNoRoute) {
  std::vector<std::string> rows(200, std::string(200, '.'));
  for (std::string& row : rows) row.replace(96, 8, "########");
  const Problem closed{.map = drawn(rows), .start = {20.5, 60.5}, .goal = {180.5, 60.5}};
  EXPECT_EQ(TubePlanner().plan(closed).status, RouteStatus::NoRoute);
  rows[30].replace(96, 8, "........");
  const Problem open{.map = drawn(rows), .start = {20.5, 60.5}, .goal = {180.5, 60.5}};
  const Plan plan = TubePlanner().plan(open);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_TRUE(violations(*open.map, plan.points).empty());
}

TEST(TubePlanner, StartEqualToGoalCostsZero) {
  const Problem problem{.map = drawn(std::vector<std::string>(100, std::string(100, '.'))),
                        .start = {45.5, 49.5},
                        .goal = {45.5, 49.5}};
  const Plan plan = TubePlanner().plan(problem);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_EQ(plan.cost_J, 0.0);
  EXPECT_EQ(plan.points, (Polyline{problem.start}));
}

TEST(TubePlanner, InvalidStartAndGoalAreReported) {
  std::vector<std::string> rows(100, std::string(100, '.'));
  rows[50].replace(40, 10, "##########");
  const Problem problem{.map = drawn(rows), .start = {45.5, 49.5}, .goal = {90.5, 90.5}};
  EXPECT_EQ(TubePlanner().plan(problem).status, RouteStatus::StartInvalid);
  Problem back = problem;
  std::swap(back.start, back.goal);
  EXPECT_EQ(TubePlanner().plan(back).status, RouteStatus::GoalInvalid);
}

}  // namespace tube_planner_test
}  // namespace talus::planner
