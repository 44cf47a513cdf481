#include <cmath>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/field/pooled_grid.hpp>
#include <talus/planner/grid/tube_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using testing::drawn;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

MapPointer rough(unsigned seed) {
  return randomMap({.width = 320, .height = 300, .seed = seed, .blocked = 0.05, .roughness = 0.12});
}

// Property: allowed, through every via point, and near what the whole field gives.
TEST(TubePlanner, IsNearTheWholeField) {
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

// Property: the same bytes with two threads, and after a change as when planned anew.
TEST(TubePlanner, SameBytesReplannedAndWithTwoThreads) {
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

// A gap that the pooled map does not show: the whole field finds it. Without a gap it proves that there is
// none.
TEST(TubePlanner, TheWholeFieldIsTheProof) {
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

TEST(TubePlanner, NothingToDriveWhereStartIsGoal) {
  const Problem problem{.map = drawn(std::vector<std::string>(100, std::string(100, '.'))),
                        .start = {45.5, 49.5},
                        .goal = {45.5, 49.5}};
  const Plan plan = TubePlanner().plan(problem);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_EQ(plan.cost_J, 0.0);
  EXPECT_EQ(plan.points, (Polyline{problem.start}));
}

TEST(TubePlanner, SaysWhatIsWrongWithAPlace) {
  std::vector<std::string> rows(100, std::string(100, '.'));
  rows[50].replace(40, 10, "##########");
  const Problem problem{.map = drawn(rows), .start = {45.5, 49.5}, .goal = {90.5, 90.5}};
  EXPECT_EQ(TubePlanner().plan(problem).status, RouteStatus::StartInvalid);
  Problem back = problem;
  std::swap(back.start, back.goal);
  EXPECT_EQ(TubePlanner().plan(back).status, RouteStatus::GoalInvalid);
}

TEST(PooledGrid, KeepsMeanGradientAndCost) {
  std::vector<std::string> rows(16, std::string(16, '^'));
  const auto map = drawn(rows);
  const auto coarse = pooled(*map, 8);
  EXPECT_EQ(coarse->grid().width, 2);
  EXPECT_EQ(coarse->grid().resolution_m, 8.0);
  const costmap::Direction north{0.0, 1.0};
  EXPECT_EQ(coarse->at({1, 1}).dzDy(), map->at({0, 0}).dzDy());
  EXPECT_EQ(coarse->cost().costPerMetre(coarse->at({0, 1}), north),
            map->cost().costPerMetre(map->at({0, 0}), north));
}

// Closed form: half of the cells cost 10 and half 50 J/m on the flat: 30 on average, which the levels of
// surcharge round by an eighth at most; mostly blocked ground is blocked, a third blocked costs half as much
// again.
TEST(PooledGrid, SurchargesWhatIsMixedOrBlocked) {
  std::vector<std::string> rows;
  for (int row = 0; row < 8; ++row) rows.push_back("..44..44########.....###");
  const auto coarse = pooled(*drawn(rows), 8);
  const costmap::Direction east{1.0, 0.0};
  EXPECT_NEAR(static_cast<double>(coarse->cost().costPerMetre(coarse->at({0, 0}), east)), 30.0, 30.0 / 8);
  EXPECT_TRUE(std::isinf(coarse->cost().costPerMetre(coarse->at({1, 0}), east)));
  EXPECT_NEAR(static_cast<double>(coarse->cost().costPerMetre(coarse->at({2, 0}), east)), 10.0 * 8 / 5,
              16.0 / 8);
}

TEST(PooledGrid, RepooledIsPooledAnew) {
  const MapPointer map = rough(5);
  const CellBox box{{37, 80}, {90, 131}};
  const costmap::Revision revision{
      .ranges = {{box.first, box.last}},
      .code = [](maps::Cell cell,
                 costmap::CellCode code) { return code.withCurve(cell.row % 3 == 0 ? 255 : 2); },
      .cost = [&] { return map->content().cost; }};
  const costmap::CostGrid newer = costmap::revised(*map, revision);
  const auto part = repooled(*pooled(*map, 8), newer, 8, box), anew = pooled(newer, 8, 2);
  const auto before = pooled(*map, 8);
  bool differs = false;
  for (int row = 0; row < anew->grid().height; ++row)
    for (int column = 0; column < anew->grid().width; ++column) {
      ASSERT_EQ(part->at({column, row}), anew->at({column, row}));
      differs = differs || !(before->at({column, row}) == anew->at({column, row}));
    }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace talus::planner
