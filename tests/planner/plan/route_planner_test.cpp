#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>

#include <talus/planner/plan/route_planner.hpp>

#include "drawn_map.hpp"
#include "rolling_ground.hpp"

namespace talus::planner {
namespace route_planner_test {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const maps::Grid kYard{.width = 60, .height = 50, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

PlanRequest overTheYard() {
  return {.start = {110.0, -40.0}, .goal = {210.0, 40.0}};
}

// A step across the map with a gap in the north; the step is not in the map's cost.
std::shared_ptr<const Chassis> stepped(const costmap::TraversabilityMap& map) {
  static const maps::Raster<float> steps = [] {
    maps::Raster<float> made(kYard, 0.0F);
    for (int row = 0; row < 45; ++row) made[{30, row}] = 1.0F;
    return made;
  }();
  return std::make_shared<const Chassis>(steps, map.model().rover(), Suspension::Rigid);
}

// Property: a plugin that plans as Talus does gives the same route through the same entry point.
TEST(RoutePlanner, PluginRouteIsCheckedAndAnnotatedLikeOurs) {
  const costmap::TraversabilityMap map = built(kYard);
  RoutePlanner own, plugin(PluginPlanner(TALUS_PLUGIN));
  for (const bool chassis : {false, true}) {
    PlanRequest request = overTheYard();
    if (chassis) request.chassis = stepped(map);
    const Route ours = own.plan(map.published(), request, {}),
                theirs = plugin.plan(map.published(), request, {});
    ASSERT_EQ(ours.status, RouteStatus::Found) << ours.reason;
    ASSERT_EQ(theirs.status, RouteStatus::Found) << theirs.reason;
    EXPECT_NEAR(theirs.summary.cost, ours.summary.cost, 1e-9 * ours.summary.cost);
    EXPECT_EQ(theirs.summary.planner, "field of talus");
    ASSERT_EQ(theirs.vertices.size(), ours.vertices.size());
    EXPECT_EQ(theirs.vertices[1].elevation_m, ours.vertices[1].elevation_m);
  }
}

TEST(RoutePlanner, PluginRejectsARiskLimit) {
  RoutePlanner plugin(PluginPlanner(TALUS_PLUGIN));
  PlanRequest request = overTheYard();
  request.risk_limit = RiskLimit{};
  EXPECT_THAT([&] { plugin.plan(built(kYard).published(), request, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("risk_limit is not honoured")));
}

TEST(OwnPlanner, ReplansOnAnUpdatedMap) {
  OwnPlanner planner;
  PlanRequest request;
  request.start = {0.5, 1.5};
  request.goal = {3.5, 1.5};
  planner.set_map(testing::drawn({"....", "....", "...."}));
  const double open_m = planner.plan(request).summary.length_m;
  planner.update(testing::drawn({"....", ".##.", "...."}));
  EXPECT_GT(planner.plan(request).summary.length_m, open_m);
  planner.update(testing::drawn({".##.", ".##.", ".##."}));
  EXPECT_EQ(planner.plan(request).status, RouteStatus::NoRoute);
  EXPECT_THROW(planner.update(testing::drawn({"....", "...."})), std::invalid_argument);
}

TEST(OwnPlanner, ViaPointsAndCheapestGoalAreUsed) {
  OwnPlanner planner;
  EXPECT_TRUE(planner.capabilities().via_points);
  EXPECT_TRUE(planner.capabilities().several_goals);
  planner.set_map(testing::drawn({"..........", "..........", ".........."}));
  PlanRequest request;
  request.start = {1.5, 1.5};
  request.goal = {9.5, 1.5};
  request.other_goals = {{4.5, 1.5}};
  EXPECT_NEAR(planner.plan(request).summary.length_m, 3.0, 1e-9);  // Closed form: to the nearer goal
  request.via = {{7.5, 1.5}};
  const Route route = planner.plan(request);  // Closed form: 6 m to the via point, 2 m to the goal
  EXPECT_NEAR(route.summary.length_m, 8.0, 1e-9);
  EXPECT_TRUE(std::ranges::any_of(route.vertices, [](const RouteVertex& v) { return v.x_m == 7.5; }));
}

TEST(OwnPlanner, InvalidSettingsAreRejectedByName) {
  OwnPlanner planner;
  EXPECT_THAT([&] { planner.configure({.planner = "PRM*"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("refused")));
  EXPECT_THAT([&] { planner.configure({.planner = "field", .threads = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("threads = 0, must be >= 1")));
  EXPECT_THROW(planner.configure({.planner = "field", .time_limit_s = -1}), std::invalid_argument);
  EXPECT_THROW(planner.plan({}), std::logic_error);
  EXPECT_THROW(planner.set_map(nullptr), std::invalid_argument);
}

TEST(OwnPlanner, CreatedPlannerHasDefaultSettingsAndNoMap) {
  OwnPlanner planner;
  planner.configure({.planner = "hybrid"});
  planner.set_map(testing::drawn({"....", "...."}));
  EXPECT_TRUE(planner.capabilities().headings);
  const auto another = planner.create();
  EXPECT_EQ(another->capabilities().planner, "field");
  EXPECT_THROW(another->plan({}), std::logic_error);
}

// Property: rejected settings change nothing.
TEST(OwnPlanner, RejectedSettingsLeaveThePlannerUnchanged) {
  OwnPlanner planner;
  planner.configure({.planner = "hybrid"});
  EXPECT_THROW(planner.configure({.planner = "no-such"}), std::invalid_argument);
  EXPECT_THROW(planner.configure({.planner = "field", .time_limit_s = NAN}), std::invalid_argument);
  EXPECT_EQ(planner.capabilities().planner, "hybrid");
}

}  // namespace route_planner_test
}  // namespace talus::planner
