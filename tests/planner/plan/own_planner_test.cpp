#include <algorithm>
#include <stop_token>

#include <talus/planner/plan/own_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace own_planner_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

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

TEST(OwnPlanner, StopYieldsCancelled) {
  OwnPlanner planner;
  planner.set_map(testing::drawn({"....", "...."}));
  std::stop_source stop;
  stop.request_stop();
  PlanRequest request;
  request.start = {0.5, 0.5};
  request.goal = {3.5, 1.5};
  request.watch.stop = stop.get_token();
  EXPECT_EQ(planner.plan(request).status, RouteStatus::Cancelled);
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

TEST(OwnPlanner, UnsupportedRequestIsRejected) {
  OwnPlanner planner;
  planner.set_map(testing::drawn({"....", "...."}));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { planner.plan(request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad is not honoured")));
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

}  // namespace own_planner_test
}  // namespace talus::planner
