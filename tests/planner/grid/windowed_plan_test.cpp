#include <cmath>

#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "rolling_ground.hpp"

namespace talus::planner {
namespace windowed_plan_test {

using namespace testing;
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
