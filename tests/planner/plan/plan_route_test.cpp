#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/plan/make_planner.hpp>
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

}  // namespace plan_route_test
}  // namespace talus::planner
