#include <cmath>

#include <talus/common/common.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/tube_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace tube_planner_test {

using testing::drawn;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

Polyline wholeFieldRoute(const Problem& problem) {
  const MotionCost cost(problem.map);
  const auto edges = std::make_shared<EdgeLayer>(
      problem.map, EdgeUnits(problem.map->cost(), problem.map->grid().resolution_m));
  CostToGo field(edges, fieldGoals(cost, problem.goal, problem.goal_tolerance_m));
  return gridRoute(cost, field, {problem.start, problem.goal});
}

constexpr TubeOptions kNarrow{.margin_cells = 8.0, .leg_cells = 100.0, .overlap_cells = 30.0, .widenings = 3};

// Property: around a guide that is the full field's own route, the tube finds an equally cheap route in one
// leg, up to rounding of edges; in several legs never a cheaper one.
TEST(TubeSearch, RouteInTheTubeMatchesTheFullField) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Problem problem{
        .map = randomMap({.width = 300, .height = 260, .seed = seed, .blocked = 0.1, .roughness = 0.15}),
        .start = {10.5, 12.5},
        .goal = {290.5, 240.5}};
    const MotionCost cost(problem.map);
    const Polyline best = wholeFieldRoute(problem);
    if (best.empty()) continue;
    const double best_J = cost.along(best);
    TubeOptions one_leg = kNarrow;
    one_leg.leg_cells = 1e4;
    EXPECT_NEAR(cost.along(tubeRoute(problem, best, one_leg)), best_J, 2e-3 * best_J) << seed;
    const Polyline way = tubeRoute(problem, best, kNarrow);
    EXPECT_GE(cost.along(way), best_J * (1 - 2e-3)) << seed;
    EXPECT_LE(cost.along(way), best_J * 1.01) << seed;
    EXPECT_EQ(way.front(), problem.start);
    EXPECT_EQ(way.back(), problem.goal);
    EXPECT_TRUE(violations(*problem.map, way).empty());
    problem.threads = 2;
    EXPECT_EQ(tubeRoute(problem, best, kNarrow), way) << seed;
  }
}

// A wall across the straight guide, with a gap far aside.
MapPointer walled(int gap_row) {
  std::vector<std::string> rows(400, std::string(400, '.'));
  for (int row = 0; row < 400; ++row)
    if (row != gap_row && row != gap_row + 1)
      rows[static_cast<std::size_t>(399 - row)].replace(200, 3, "###");
  return drawn(rows);
}

TEST(TubeSearch, TubeWidensUntilARouteExists) {
  const Problem problem{.map = walled(330), .start = {20.5, 60.5}, .goal = {380.5, 60.5}};
  const Polyline guide{problem.start, problem.goal};
  TubeOptions options{.margin_cells = 48.0, .leg_cells = 1e4, .widenings = 0};
  EXPECT_TRUE(tubeRoute(problem, guide, options).empty());
  options.widenings = 3;
  const Polyline way = tubeRoute(problem, guide, options);
  ASSERT_FALSE(way.empty());
  const MotionCost cost(problem.map);
  EXPECT_NEAR(cost.along(way), cost.along(wholeFieldRoute(problem)), 1e-3 * cost.along(way));
}

// A patch whose cost decreases northwards draws the route to the border of the first tube, which then
// widens.
TEST(TubeSearch, TubeWidensIfTheRouteTouchesItsBorder) {
  std::vector<std::string> rows(400, std::string(400, '.'));
  for (int row = 0; row < 200; ++row)
    rows[static_cast<std::size_t>(399 - row)].replace(150, 100, std::string(100, "44443210"[row / 25]));
  const Problem problem{.map = drawn(rows), .start = {20.5, 60.5}, .goal = {380.5, 60.5}};
  const Polyline guide{problem.start, problem.goal};
  const MotionCost cost(problem.map);
  const double best_J = cost.along(wholeFieldRoute(problem));
  TubeOptions options{.margin_cells = 48.0, .leg_cells = 1e4, .widenings = 0};
  EXPECT_GT(cost.along(tubeRoute(problem, guide, options)), 1.02 * best_J);
  options.widenings = 3;
  EXPECT_NEAR(cost.along(tubeRoute(problem, guide, options)), best_J, 1e-3 * best_J);
}

// A leg that would end in a dead end is joined with the next leg.
TEST(TubeSearch, BlockedLegIsJoinedWithTheNext) {
  std::vector<std::string> rows(100, std::string(400, '.'));
  for (int row = 40; row < 60; ++row)
    for (int column = 270; column < 290; ++column)
      if (row == 40 || row == 59 || column == 270 || column == 289)
        rows[static_cast<std::size_t>(99 - row)][static_cast<std::size_t>(column)] = '#';
  const Problem problem{.map = drawn(rows), .start = {20.5, 50.5}, .goal = {380.5, 50.5}};
  const TubeOptions options{.margin_cells = 48.0, .leg_cells = 100.0, .overlap_cells = 30.0, .widenings = 1};
  const Polyline way = tubeRoute(problem, {problem.start, problem.goal}, options);
  ASSERT_FALSE(way.empty());
  EXPECT_TRUE(violations(*problem.map, way).empty());
  const MotionCost cost(problem.map);
  EXPECT_NEAR(cost.along(way), cost.along(wholeFieldRoute(problem)), 1e-2 * cost.along(way));
}

TEST(TubeSearch, StopYieldsNoRoute) {
  std::stop_source source;
  source.request_stop();
  ProgressMonitor watch;
  watch.stop = source.get_token();
  const Problem problem{.map = walled(70), .start = {20.5, 60.5}, .goal = {380.5, 60.5}};
  EXPECT_TRUE(tubeRoute(problem, {problem.start, problem.goal}, {}, StopCheck(watch)).empty());
}

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
