#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <talus/planner/plugin/plugin_loader.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(PluginLoader, LoadsAPlannerAndPlansWithIt) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  EXPECT_EQ(planner->capabilities().interface_version, kPlannerInterfaceVersion);
  EXPECT_THAT(planner->capabilities().planners, ::testing::Contains("field"));
  planner->set_map(testing::drawn({"....", ".##.", "...."}));
  PlanRequest request;
  request.start = {0.5, 1.5};
  request.goal = {3.5, 1.5};
  const Route route = planner->plan(request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_EQ(route.summary.planner, "field");
  EXPECT_GE(route.vertices.size(), 4u);  // Property: the way round two cells has at least two turns
}

TEST(PluginLoader, APlannerSurvivesItsLoader) {
  std::unique_ptr<GlobalPlanner> another;
  const auto planner = loadPlugin(TALUS_PLUGIN);
  another = planner->create();
  EXPECT_EQ(another->capabilities().name, "talus");
}

TEST(PluginLoader, ReplansOnANewerVersionOfTheMap) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  PlanRequest request;
  request.start = {0.5, 1.5};
  request.goal = {3.5, 1.5};
  planner->set_map(testing::drawn({"....", "....", "...."}));
  const double open_m = planner->plan(request).summary.length_m;
  planner->update(testing::drawn({"....", ".##.", "...."}));
  EXPECT_GT(planner->plan(request).summary.length_m, open_m);
  planner->update(testing::drawn({".##.", ".##.", ".##."}));
  EXPECT_EQ(planner->plan(request).status, RouteStatus::NoRoute);
  EXPECT_THROW(planner->update(testing::drawn({"....", "...."})), std::invalid_argument);
}

TEST(PluginLoader, PassesViaPointsAndTakesTheCheapestGoal) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  EXPECT_TRUE(planner->capabilities().via_points);
  EXPECT_TRUE(planner->capabilities().several_goals);
  planner->set_map(testing::drawn({"..........", "..........", ".........."}));
  PlanRequest request;
  request.start = {1.5, 1.5};
  request.goal = {9.5, 1.5};
  request.other_goals = {{4.5, 1.5}};
  EXPECT_NEAR(planner->plan(request).summary.length_m, 3.0, 1e-9);  // Closed form: straight to the nearer
  request.via = {{7.5, 1.5}};
  const Route route = planner->plan(request);  // Closed form: 6 to the via point, and 2 on beats 3 back
  EXPECT_NEAR(route.summary.length_m, 8.0, 1e-9);
  EXPECT_TRUE(std::ranges::any_of(route.vertices, [](const RouteVertex& v) { return v.x_m == 7.5; }));
}

TEST(PluginLoader, CancelledPlanningSaysSo) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  planner->set_map(testing::drawn({"....", "...."}));
  std::stop_source stop;
  stop.request_stop();
  PlanRequest request;
  request.start = {0.5, 0.5};
  request.goal = {3.5, 1.5};
  request.watch.stop = stop.get_token();
  EXPECT_EQ(planner->plan(request).status, RouteStatus::Cancelled);
}

TEST(PluginLoader, RefusesSettingsByName) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  EXPECT_THAT([&] { planner->configure({.planner = "PRM*"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("refused")));
  EXPECT_THAT([&] { planner->configure({.planner = "field", .threads = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("threads = 0, must be >= 1")));
  EXPECT_THROW(planner->configure({.planner = "field", .time_limit_s = -1}), std::invalid_argument);
  EXPECT_THROW(planner->plan({}), std::logic_error);
  EXPECT_THROW(planner->set_map(nullptr), std::invalid_argument);
}

TEST(PluginLoader, RefusesWhatThePlannerDoesNotHonour) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  planner->set_map(testing::drawn({"....", "...."}));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { planner->plan(request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad is not honoured")));
}

TEST(PluginLoader, TheLibraryStaysAsLongAsWhatItCreated) {
  std::unique_ptr<GlobalPlanner> another = loadPlugin(TALUS_PLUGIN)->create();
  another->set_map(testing::drawn({"....", "...."}));
  PlanRequest request;
  request.start = {0.5, 0.5};
  request.goal = {3.5, 0.5};
  EXPECT_EQ(another->plan(request).status, RouteStatus::Found);
}

TEST(PluginLoader, AnotherInterfaceIsRefusedBeforeItIsTouched) {
  EXPECT_THAT([] { loadPlugin(TALUS_OTHER_PLUGIN); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("built for planner interface 99"),
                                              HasSubstr("this program has 3"), HasSubstr("rebuild"))));
}

TEST(PluginLoader, WhatIsNoPluginIsRefusedByName) {
  EXPECT_THAT([] { loadPlugin("/nowhere/planner.so"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("/nowhere/planner.so"), HasSubstr("no such file"))));
  EXPECT_THROW(loadPlugin("/"), InputError);
  EXPECT_THROW(loadPlugin(""), InputError);
  const auto text = std::filesystem::temp_directory_path() / "talus_no_plugin_test.so";
  std::ofstream(text) << "not a library\n";
  EXPECT_THAT([&] { loadPlugin(text.string()); }, ThrowsMessage<InputError>(HasSubstr("cannot be loaded")));
  std::filesystem::remove(text);
  EXPECT_THAT([] { loadPlugin(TALUS_PLAIN_LIBRARY); },
              ThrowsMessage<InputError>(HasSubstr("exports no talus_planner")));
}

}  // namespace
}  // namespace talus::planner
