#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plan/plan_route.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "drawn_map.hpp"
#include "rolling_ground.hpp"

namespace talus::planner {
namespace plan_route_test {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const maps::Grid kPart{.width = 150, .height = 120, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

PlanRequest across() {
  return {.start = {120.0, -20.0}, .goal = {370.0, 160.0}};
}

TEST(PlanRoute, RouteEqualsMakePlannerWithElevationAdded) {
  const costmap::TraversabilityMap map = built(kPart);
  for (const char* name : {"field", "hybrid"}) {
    const auto planner = makePlanner(name);
    planner->set_map(map.published());
    const Route kept = planner->plan(across());
    const Route route = planRoute(map.published(), across(), {.planner = name});
    ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
    EXPECT_EQ(route.summary.cost, kept.summary.cost);
    EXPECT_EQ(route.summary.planner, name);
    ASSERT_EQ(route.vertices.size(), kept.vertices.size());
    for (std::size_t i = 0; i < route.vertices.size(); ++i) {
      const RouteVertex &v = route.vertices[i], &other = kept.vertices[i];
      EXPECT_EQ(v.x_m, other.x_m);
      EXPECT_EQ(v.y_m, other.y_m);
      EXPECT_EQ(v.elevation_m, other.elevation_m);
      EXPECT_EQ(v.elevation_m, maps::elevationAt(map.elevation().elevation_m, {v.x_m, v.y_m}));
    }
  }
}

TEST(PlanRoute, ElevationIsThatOfThePlannedVersion) {
  costmap::TraversabilityMap map = built(kPart);
  const auto before = map.published();
  maps::Raster<float> raised(kPart);
  for (int row = 0; row < kPart.height; ++row)
    for (int column = 0; column < kPart.width; ++column)
      raised[{column, row}] = 3.0F + height(kPart.centre({column, row}));
  map.patch({.elevation_m = raised, .rock_abundance = {}, .classes = {}, .keep_out = {}});
  const Route old_route = planRoute(before, across()), new_route = planRoute(map.published(), across());
  ASSERT_EQ(old_route.status, RouteStatus::Found) << old_route.reason;
  ASSERT_EQ(new_route.status, RouteStatus::Found) << new_route.reason;
  // Closed form: all ground lies 3 m higher.
  EXPECT_NEAR(new_route.vertices[0].elevation_m - old_route.vertices[0].elevation_m, 3.0, 1e-5);
}

TEST(PlanRoute, ElevationIsNanWithoutHeights) {
  const Route route = planRoute(drawn({"....", "...."}), {.start = {0.5, 0.5}, .goal = {3.5, 1.5}});
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(std::isnan(route.vertices.front().elevation_m));
}

TEST(PlanRoute, RouteStatesTheGoalItReaches) {
  PlanRequest request{.start = {1.5, 0.5}, .goal = {9.5, 0.5}};
  request.other_goals = {{8.5, 0.5}, {3.5, 0.5}};
  const auto map = drawn({".........."});
  EXPECT_EQ(planRoute(map, request).goal, 2U);  // Closed form: the nearest goal on level ground
  request.other_goals.clear();
  EXPECT_EQ(planRoute(map, request).goal, 0U);
}

TEST(PlanRoute, InvalidRequestIsRejectedByName) {
  const auto map = drawn({"....", "...."});
  PlanRequest request{.start = {0.5, 0.5}, .goal = {3.5, 1.5}};
  EXPECT_THAT([&] { planRoute(nullptr, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no map")));
  EXPECT_THAT([&] { planRoute(map, request, {.planner = "feild"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("field")));
  EXPECT_THAT([&] { planRoute(map, request, {.threads = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("threads = 0, must be >= 1")));
  request.goal_heading_rad = 1.0;
  EXPECT_THAT([&] { planRoute(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("goal_heading_rad is not honoured")));
  request.goal_heading_rad.reset();
  request.goal.x_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { planRoute(map, request); }, ThrowsMessage<std::invalid_argument>(HasSubstr("goal.x_m")));
}

TEST(PlanRoute, WindowedRouteIsWithinAFewPercentOfTheFullMap) {
  int asked = 0;
  WindowedMap map = windows(asked);
  const PlanRequest request{.start = {150.0, 0.0}, .goal = {1400.0, 850.0}};
  const Route route = planRoute(map, request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(
      std::ranges::all_of(route.vertices, [](const auto& v) { return std::isfinite(v.elevation_m); }));
  // Property: the route is allowed on the whole map at the same cost.
  std::vector<maps::Point> points;
  for (const RouteVertex& v : route.vertices) points.push_back({v.x_m, v.y_m});
  const double price_J = MotionCost(built(kWhole).published()).along(points);
  EXPECT_NEAR(price_J, route.summary.cost, 1e-6 * price_J);
}

TEST(PlanRoute, WindowedPlanningRejectsUnsupportedRequests) {
  int asked = 0;
  WindowedMap map = windows(asked);
  EXPECT_THAT([&] { planRoute(map, {}, {.planner = "hybrid"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'hybrid' does not plan in windows")));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { planRoute(map, request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad")));
  EXPECT_THROW(planRoute(map, {}, {.threads = 0}), std::invalid_argument);
  EXPECT_EQ(asked, 0);  // nothing is built for a rejected request
}

const std::vector<std::string> kOpen(30, std::string(40, '.'));

PlanRequest overOpenGround() {
  PlanRequest request;
  request.start = {5.5, 15.5};
  request.goal = {34.5, 15.5};
  return request;
}

TEST(MakePlanner, CreatesThePlannerOfTheGivenName) {
  EXPECT_EQ(makePlanner()->capabilities().planner, "field");
  const auto planner = makePlanner("field");
  planner->set_map(testing::drawn(kOpen));
  EXPECT_NEAR(planner->plan(overOpenGround()).summary.length_m, 29.0,
              1e-9);  // Closed form: straight on the flat
  EXPECT_THROW(makePlanner("no-such"), std::invalid_argument);
}

TEST(MakePlanner, HeadingsAndTurningRadiusAreMetOrRejected) {
  PlanRequest request = overOpenGround();
  request.start_heading_rad = request.goal_heading_rad = std::numbers::pi / 2;
  request.kinematics = Kinematics{.turning_radius_m = 3.0, .may_reverse = false};
  const auto field = makePlanner("field");
  field->set_map(testing::drawn(kOpen));
  EXPECT_THAT([&] { field->plan(request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad is not honoured")));

  const auto hybrid = makePlanner("hybrid");
  EXPECT_TRUE(hybrid->capabilities().headings && hybrid->capabilities().reversing);
  hybrid->set_map(testing::drawn(kOpen));
  const Route route = hybrid->plan(request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_NEAR(route.vertices.front().heading_rad, std::numbers::pi / 2, 0.1);
  EXPECT_NEAR(route.vertices.back().heading_rad, std::numbers::pi / 2, 0.1);
  ASSERT_TRUE(route.summary.drive);
  EXPECT_LE(route.summary.drive->max_curvature_1_m, 1.0 / 3.0 + 1e-9);
  EXPECT_EQ(route.summary.drive->cusps, 0);
}

TEST(MakePlanner, SeedThreadsAndTimeLimitComeFromSettings) {
  const auto planner = makePlanner();
  planner->set_map(testing::drawn(kOpen));
  planner->configure({.planner = "RRTstar", .seed = 3, .time_limit_s = 0.2});
  EXPECT_EQ(planner->capabilities().planner, "RRTstar");
  EXPECT_EQ(planner->plan(overOpenGround()).status, RouteStatus::Found);
  EXPECT_THROW(planner->configure({.threads = 0}), std::invalid_argument);
}

TEST(MakePlanner, ChassisAndRiskLimitAreEnforced) {
  // A step of 0.5 m across the map with a gap in the north; the step is not in the cost map.
  const maps::Grid grid{.width = 40, .height = 30, .resolution_m = 1.0, .south_west = {}};
  maps::Raster<float> steps(grid, 0.0F);
  for (int row = 0; row < 22; ++row) steps[{20, row}] = 0.5F;
  terramech::Rover rover;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = rover.track_m = 0.8;
  rover.clearance_m = 0.3;
  const auto planner = makePlanner("field");
  planner->set_map(testing::drawn(kOpen));
  PlanRequest request = overOpenGround();
  request.chassis = std::make_shared<const Chassis>(steps, rover, Suspension::Rigid);
  const Route round = planner->plan(request);
  ASSERT_EQ(round.status, RouteStatus::Found) << round.reason;
  EXPECT_GT(round.summary.length_m, 30.0);
  request = overOpenGround();
  request.risk_limit = RiskLimit{.immobilisation = 0.5};
  EXPECT_EQ(planner->plan(request).status, RouteStatus::Found);
}

}  // namespace plan_route_test
}  // namespace talus::planner
