#include <cmath>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/polyline.hpp>

#include "rolling_ground.hpp"

namespace talus::planner {

namespace windowed_plan_test {

using namespace testing;

TEST(WindowedMap, TilesBesideALineEqualTheFullMap) {
  // Property: the cell codes equal those of the whole map, and cells outside the windows are unknown.
  int asked = 0;
  WindowedMap map = windows(asked);
  const std::vector<maps::Point> line{{250.0, 100.0}, {900.0, 400.0}};
  const auto near = map.around(line, 64.0);
  const auto whole = built(kWhole).published();
  std::size_t same = 0, unknown = 0;
  for (int row = 0; row < kWhole.height; ++row)
    for (int column = 0; column < kWhole.width; ++column) {
      const costmap::CellCode code = near->at({column, row});
      if (code.curve() == costmap::CellCode::kUnknown)
        ++unknown;
      else if (code == whole->at({column, row}))
        ++same;
      else
        FAIL() << "another code at " << column << ", " << row;
    }
  EXPECT_GT(same, 60'000U);
  EXPECT_GT(unknown, 100'000U);
  EXPECT_LE(map.cellsBuilt(), 300'000U);
  ASSERT_TRUE(map.elevation_m({500.0, 215.0}));
  EXPECT_NEAR(*map.elevation_m({500.0, 215.0}), height({500.0, 215.0}), 0.02);  // bilinear between 2 m cells
  EXPECT_FALSE(map.elevation_m({1400.0, -40.0}));
  const int before = asked;
  map.around(line, 64.0);
  EXPECT_EQ(asked, before);  // cached windows are not built again
}

TEST(WindowedMap, InvalidOptionsAreRejected) {
  EXPECT_REFUSED(WindowedMap({.grid = kWhole}), std::invalid_argument, "no overview");
  int asked = 0;
  WindowedMap map = windows(asked);
  WindowedMap shifted({.grid = kWhole, .overview = map.overview(), .build = [](const MapBox& box) {
                         maps::Grid grid = gridOf(box);
                         grid.south_west.x_m += 1.0;
                         return std::optional(built(grid));
                       }});
  EXPECT_REFUSED(shifted.around({{250.0, 100.0}}, 10.0), std::invalid_argument,
                 "what was built is not the cells of the box");
}

using ::testing::HasSubstr;

Problem problemOn(const WindowedMap& map, maps::Point start, maps::Point goal) {
  return {.map = map.overview(), .start = start, .goal = goal, .prove = false};
}

// Property: the legs meet at the via point, the plan's cost equals that on the map of its tiles, and the map
// has the grid of the whole map, of which only a portion was built.
TEST(WindowedPlan, LegsMeetAtViaPointsAndOnlyNearbyTilesAreBuilt) {
  int asked = 0;
  WindowedMap map = windows(asked);
  Problem problem = problemOn(map, {150.0, 0.0}, {900.0, 600.0});
  problem.via = {{700.0, 100.0}};
  const Plan plan = planInWindows(problem, map);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_NE(std::ranges::find(plan.points, problem.via[0]), plan.points.end());
  EXPECT_EQ(problem.map->grid().resolution_m, kCell_m);
  EXPECT_NEAR(MotionCost(problem.map).along(plan.points), plan.cost_J, 1e-9 * plan.cost_J);
  EXPECT_GT(asked, 0);
  EXPECT_LT(map.cellsBuilt(), kWhole.size());
}

// Property: the route costs little more than that on the whole map, whatever the number of threads.
TEST(WindowedPlan, RouteIsNearlyAsCheapAsThatOnTheWholeMap) {
  int asked = 0;
  WindowedMap map = windows(asked);
  Problem problem = problemOn(map, {150.0, 0.0}, {1400.0, 850.0});
  const Plan plan = planInWindows(problem, map);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_TRUE(violations(*problem.map, plan.points).empty());
  Problem whole = problem;
  whole.map = built(kWhole).published();
  const Plan best = FieldPlanner().plan(whole);
  EXPECT_NEAR(MotionCost(whole.map).along(plan.points), plan.cost_J, 1e-9 * plan.cost_J);
  EXPECT_LE(plan.cost_J, 1.02 * best.cost_J);
  Problem again = problemOn(map, problem.start, problem.goal);
  again.threads = 2;
  EXPECT_EQ(planInWindows(again, map).points, plan.points);
}

float level(maps::Point) {
  return 0.0F;
}

// The overview shows neither a wall across the guide, whose gap is far aside, nor a ring around the place at
// which two parts of the guide meet: the window is widened, and the parts are joined.
TEST(WindowedPlan, RouteLeadsAroundWhatTheOverviewDoesNotShow) {
  const auto walls = [](maps::Point p) {
    const bool wall = std::abs(p.x_m - 500.0) < 6.0 && std::abs(p.y_m - 850.0) > 10.0;
    const double from_joint_m = std::hypot(p.x_m - (1400.0 - 384.0 * kCell_m), p.y_m - 200.0);
    return wall || std::abs(from_joint_m - 30.0) < 6.0 ? 8.0F : 0.0F;
  };
  int asked = 0;
  WindowedMap map = windows(asked, walls, level);
  Problem problem = problemOn(map, {200.0, 200.0}, {1400.0, 200.0});
  const Plan plan = planInWindows(problem, map);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_TRUE(violations(*problem.map, plan.points).empty());
  Problem whole = problem;
  whole.map = built(kWhole, walls).published();
  const Plan best = FieldPlanner().plan(whole);
  ASSERT_EQ(best.status, RouteStatus::Found) << best.reason;
  EXPECT_LE(plan.cost_J, 1.02 * best.cost_J);
}

TEST(WindowedPlan, StopYieldsNoRoute) {
  std::stop_source source;
  source.request_stop();
  int asked = 0;
  WindowedMap map = windows(asked);
  Problem problem = problemOn(map, {150.0, 0.0}, {900.0, 600.0});
  problem.watch.stop = source.get_token();
  const Plan plan = planInWindows(problem, map);
  EXPECT_TRUE(plan.points.empty());
  EXPECT_TRUE(plan.interrupted);
}

TEST(WindowedPlan, MissingOverviewRouteNamesARemedy) {
  int asked = 0;
  const WindowedMap open = windows(asked);
  const costmap::CostGrid& overview = *open.overview();
  const int middle = overview.grid().width / 2, height = overview.grid().height;
  const costmap::Revision wall{.ranges = {{{middle, 0}, {middle, height - 1}}},
                               .code = [](maps::Cell, costmap::CellCode code) { return code.withCurve(255); },
                               .cost = [&] { return overview.content().cost; }};
  WindowedMap walled({.grid = kWhole,
                      .overview = std::make_shared<costmap::CostGrid>(costmap::revised(overview, wall)),
                      .build = [&asked](const MapBox& box) {
                        ++asked;
                        return std::optional(built(gridOf(box)));
                      }});
  Problem problem = problemOn(walled, {150.0, 0.0}, {1400.0, 600.0});
  const Plan plan = planInWindows(problem, walled);
  EXPECT_EQ(plan.status, RouteStatus::NoneFound);
  EXPECT_THAT(plan.reason, HasSubstr("no route found on the overview; plan on a part with --window"));
  EXPECT_EQ(asked, 0);
}

}  // namespace windowed_plan_test

}  // namespace talus::planner
