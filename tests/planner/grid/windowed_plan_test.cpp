#include <cmath>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"
#include "rolling_ground.hpp"

namespace talus::planner {

namespace windowed_plan_test {

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
