#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/maps/maps.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"
#include "rolling_ground.hpp"

namespace talus::planner {
namespace planner_test {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const maps::Grid kPart{.width = 150, .height = 120, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

PlanRequest across() {
  return {.start = {120.0, -20.0}, .goal = {370.0, 160.0}};
}

TEST(Planner, VerticesHaveTheElevationOfTheMap) {
  const costmap::TraversabilityMap map = built(kPart);
  for (const char* name : {"field", "hybrid"}) {
    const Route route = Planner({.planner = name}).plan(map.published(), across());
    ASSERT_TRUE(route.found()) << route.reason;
    EXPECT_EQ(route.planner, name);
    for (const RouteVertex& v : route.vertices)
      EXPECT_EQ(v.elevation_m, maps::elevationAt(map.elevation().elevation_m, {v.x_m, v.y_m}));
  }
}

TEST(Planner, ElevationIsThatOfThePlannedVersion) {
  costmap::TraversabilityMap map = built(kPart);
  const auto before = map.published();
  maps::Raster<float> raised(kPart);
  for (int row = 0; row < kPart.height; ++row)
    for (int column = 0; column < kPart.width; ++column)
      raised[{column, row}] = 3.0F + height(kPart.centre({column, row}));
  map.patch({.elevation_m = raised, .rock_abundance = {}, .classes = {}, .keep_out = {}});
  const Route old_route = Planner().plan(before, across()),
              new_route = Planner().plan(map.published(), across());
  ASSERT_EQ(old_route.status, RouteStatus::Found) << old_route.reason;
  ASSERT_EQ(new_route.status, RouteStatus::Found) << new_route.reason;
  // Closed form: all ground lies 3 m higher.
  EXPECT_NEAR(new_route.vertices[0].elevation_m - old_route.vertices[0].elevation_m, 3.0, 1e-5);
}

TEST(Planner, ElevationIsNanWithoutHeights) {
  const Route route = Planner().plan(drawn({"....", "...."}), {.start = {0.5, 0.5}, .goal = {3.5, 1.5}});
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(std::isnan(route.vertices.front().elevation_m));
}

TEST(Planner, RouteStatesTheGoalItReaches) {
  PlanRequest request{.start = {1.5, 0.5}, .goal = {9.5, 0.5}};
  request.other_goals = {{8.5, 0.5}, {3.5, 0.5}};
  const auto map = drawn({".........."});
  EXPECT_EQ(Planner().plan(map, request).goal, 2U);  // Closed form: the nearest goal on level ground
  request.other_goals.clear();
  EXPECT_EQ(Planner().plan(map, request).goal, 0U);
}

TEST(Planner, InvalidRequestIsRejectedByName) {
  const auto map = drawn({"....", "...."});
  PlanRequest request{.start = {0.5, 0.5}, .goal = {3.5, 1.5}};
  EXPECT_THAT([&] { Planner().plan(nullptr, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no map")));
  EXPECT_THAT([&] { Planner({.planner = "feild"}).plan(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("field")));
  EXPECT_THAT([&] { Planner({.threads = 0}).plan(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("threads = 0, must be >= 1")));
  request.goal_heading_rad = 1.0;
  EXPECT_THAT([&] { Planner().plan(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("goal_heading_rad is not honoured")));
  request.goal_heading_rad.reset();
  request.goal.x_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { Planner().plan(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("goal.x_m")));
}

TEST(Planner, WindowedRouteIsWithinAFewPercentOfTheFullMap) {
  int asked = 0;
  WindowedMap map = windows(asked);
  const PlanRequest request{.start = {150.0, 0.0}, .goal = {1400.0, 850.0}};
  const Route route = Planner().plan(map, request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(
      std::ranges::all_of(route.vertices, [](const auto& v) { return std::isfinite(v.elevation_m); }));
  // Property: the route is allowed on the whole map at the same cost.
  std::vector<maps::Point> points;
  for (const RouteVertex& v : route.vertices) points.push_back({v.x_m, v.y_m});
  const double price_J = MotionCost(built(kWhole).published()).along(points);
  EXPECT_NEAR(price_J, route.cost, 1e-6 * price_J);
}

TEST(Planner, WindowedPlanningRejectsUnsupportedRequests) {
  int asked = 0;
  WindowedMap map = windows(asked);
  EXPECT_THAT([&] { Planner({.planner = "hybrid"}).plan(map, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'hybrid' does not plan in windows")));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { Planner().plan(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad")));
  EXPECT_THROW(Planner({.threads = 0}).plan(map, {}), std::invalid_argument);
  EXPECT_EQ(asked, 0);  // nothing is built for a rejected request
}

const std::vector<std::string> kOpen(30, std::string(40, '.'));

PlanRequest overOpenGround() {
  PlanRequest request;
  request.start = {5.5, 15.5};
  request.goal = {34.5, 15.5};
  return request;
}

TEST(Planner, CreatesThePlannerOfTheGivenName) {
  EXPECT_EQ(Planner().capabilities().planner, "field");
  // Closed form: straight on the flat.
  EXPECT_NEAR(Planner().plan(testing::drawn(kOpen), overOpenGround()).length_m, 29.0, 1e-9);
  EXPECT_THROW(Planner({.planner = "no-such"}), std::invalid_argument);
}

TEST(Planner, HeadingsAndTurningRadiusAreMetOrRejected) {
  PlanRequest request = overOpenGround();
  request.start_heading_rad = request.goal_heading_rad = std::numbers::pi / 2;
  request.kinematics = Kinematics{.turning_radius_m = 3.0, .may_reverse = false};
  EXPECT_THAT([&] { Planner().plan(testing::drawn(kOpen), request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad is not honoured")));

  Planner hybrid({.planner = "hybrid"});
  EXPECT_TRUE(hybrid.capabilities().headings && hybrid.capabilities().reversing);
  const Route route = hybrid.plan(testing::drawn(kOpen), request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_NEAR(route.vertices.front().heading_rad, std::numbers::pi / 2, 0.1);
  EXPECT_NEAR(route.vertices.back().heading_rad, std::numbers::pi / 2, 0.1);
  ASSERT_TRUE(route.drive);
  EXPECT_LE(route.drive->max_curvature_1_m, 1.0 / 3.0 + 1e-9);
  EXPECT_EQ(route.drive->cusps, 0);
}

TEST(Planner, SeedThreadsAndTimeLimitComeFromSettings) {
  Planner planner({.planner = "RRTstar", .seed = 3, .time_limit_s = 0.2});
  EXPECT_EQ(planner.capabilities().planner, "RRTstar");
  EXPECT_TRUE(planner.plan(testing::drawn(kOpen), overOpenGround()).found());
  EXPECT_THAT([] { Planner({.planner = "PRM*"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("refused")));
  EXPECT_THROW(Planner({.time_limit_s = -1}), std::invalid_argument);
}

TEST(Planner, ChassisAndRiskLimitAreEnforced) {
  // A step of 0.5 m across the map with a gap in the north; the step is not in the cost map.
  const maps::Grid grid{.width = 40, .height = 30, .resolution_m = 1.0, .south_west = {}};
  maps::Raster<float> steps(grid, 0.0F);
  for (int row = 0; row < 22; ++row) steps[{20, row}] = 0.5F;
  terramech::Rover rover;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = rover.track_m = 0.8;
  rover.clearance_m = 0.3;
  const auto map = testing::drawn(kOpen);
  Planner planner;
  PlanRequest request = overOpenGround();
  request.chassis = std::make_shared<const Chassis>(steps, rover, Suspension::Rigid);
  const Route round = planner.plan(map, request);
  ASSERT_EQ(round.status, RouteStatus::Found) << round.reason;
  EXPECT_GT(round.length_m, 30.0);
  request = overOpenGround();
  request.risk_limit = RiskLimit{.immobilisation = 0.5};
  EXPECT_TRUE(planner.plan(map, request).found());
}

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
TEST(Planner, PluginRouteIsCheckedAndAnnotatedLikeOurs) {
  const costmap::TraversabilityMap map = built(kYard);
  Planner own, plugin({}, TALUS_PLUGIN);
  for (const bool chassis : {false, true}) {
    PlanRequest request = overTheYard();
    if (chassis) request.chassis = stepped(map);
    const Route ours = own.plan(map.published(), request), theirs = plugin.plan(map.published(), request);
    ASSERT_EQ(ours.status, RouteStatus::Found) << ours.reason;
    ASSERT_EQ(theirs.status, RouteStatus::Found) << theirs.reason;
    EXPECT_NEAR(theirs.cost, ours.cost, 1e-9 * ours.cost);
    EXPECT_EQ(theirs.planner, "field of talus");
    ASSERT_EQ(theirs.vertices.size(), ours.vertices.size());
    EXPECT_EQ(theirs.vertices[1].elevation_m, ours.vertices[1].elevation_m);
  }
}

TEST(Planner, PluginRejectsARiskLimit) {
  Planner plugin({}, TALUS_PLUGIN);
  PlanRequest request = overTheYard();
  request.risk_limit = RiskLimit{};
  EXPECT_THAT([&] { plugin.plan(built(kYard).published(), request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("risk_limit is not honoured")));
}

TEST(Planner, ViaPointsAndCheapestGoalAreUsed) {
  Planner planner;
  const auto map = testing::drawn({"..........", "..........", ".........."});
  EXPECT_TRUE(planner.capabilities().via_points);
  EXPECT_TRUE(planner.capabilities().several_goals);
  PlanRequest request;
  request.start = {1.5, 1.5};
  request.goal = {9.5, 1.5};
  request.other_goals = {{4.5, 1.5}};
  EXPECT_NEAR(planner.plan(map, request).length_m, 3.0, 1e-9);  // Closed form: to the nearer goal
  request.via = {{7.5, 1.5}};
  const Route route = planner.plan(map, request);  // Closed form: 6 m to the via point, 2 m to the goal
  EXPECT_NEAR(route.length_m, 8.0, 1e-9);
  EXPECT_TRUE(std::ranges::any_of(route.vertices, [](const RouteVertex& v) { return v.x_m == 7.5; }));
}

TEST(OwnPlugin, ReplansOnAnUpdatedMap) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  PlanRequest request;
  request.start = {0.5, 1.5};
  request.goal = {3.5, 1.5};
  planner->set_map(testing::drawn({"....", "....", "...."}));
  const double open_m = planner->plan(request).length_m;
  planner->update(testing::drawn({"....", ".##.", "...."}));
  EXPECT_GT(planner->plan(request).length_m, open_m);
  planner->update(testing::drawn({".##.", ".##.", ".##."}));
  EXPECT_EQ(planner->plan(request).status, RouteStatus::NoRoute);
  EXPECT_THROW(planner->update(testing::drawn({"....", "...."})), std::invalid_argument);
  EXPECT_THROW(planner->set_map(nullptr), std::invalid_argument);
}

TEST(OwnPlugin, CreatedPlannerHasDefaultSettingsAndNoMap) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  planner->configure({.planner = "hybrid"});
  planner->set_map(testing::drawn({"....", "...."}));
  EXPECT_THROW(planner->configure({.planner = "no-such"}), std::invalid_argument);  // changes nothing
  EXPECT_TRUE(planner->capabilities().headings);
  const auto another = planner->create();
  EXPECT_EQ(another->capabilities().planner, "field");
  EXPECT_THROW(another->plan({}), std::logic_error);
}

// Property: explanation and route are those of the traversability map.
TEST(Map, IsExplainedAndPlannedOnAsItsGround) {
  Map map(built(kYard));
  const maps::Cell cell{20, 20};
  const maps::Point place = map.ground().grid().centre(cell);
  EXPECT_EQ(map.explain(place, 0.5).verdict,
            costmap::explain(map.ground(), cell, costmap::Direction{std::cos(0.5), std::sin(0.5)}).verdict);
  EXPECT_EQ(map.explain(place).category, costmap::explain(map.ground(), cell).category);
  EXPECT_THROW(map.explain({-1e6, 0.0}), std::invalid_argument);
  map.ground().refuse(overTheYard().goal, 5.0);
  map.ground().publish();
  const Route route = Planner().plan(map, overTheYard());
  EXPECT_EQ(route.status, RouteStatus::GoalInvalid);
}

}  // namespace planner_test
}  // namespace talus::planner
