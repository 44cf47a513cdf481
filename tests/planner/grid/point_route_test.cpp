#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/point_route.hpp>

#include "steered_ground.hpp"

namespace talus::planner {
namespace point_route_test {

using testing::drawn;
using testing::randomBand;
using testing::randomMap;

// Property: the route is allowed from end to end, costs at least the lower bound, and at most 2 % more than
// the refined route of the grid.
TEST(PointRoute, CostIsWithinTwoPercentOfTheRefinedRoute) {
  int found = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto map = randomMap({.width = 14, .height = 12, .seed = seed, .blocked = 0.15, .roughness = 0.2});
    const MotionCost cost(map);
    const Segment places{{0.5, 0.5}, {13.4, 11.3}};
    if (!cost.allowed(places.from) || !cost.allowed(places.to)) continue;
    const Polyline route = pointRoute(cost, places, 0.0, kInfinity);
    const Plan other = FieldPlanner().plan({.map = map, .start = places.from, .goal = places.to});
    if (other.status == RouteStatus::Found) {
      ASSERT_FALSE(route.empty()) << seed;
      EXPECT_LE(cost.along(route), 1.02 * other.cost_J) << seed;
    }
    if (route.empty()) continue;
    ++found;
    EXPECT_EQ(route.front(), places.from);
    EXPECT_EQ(route.back(), places.to);
    EXPECT_TRUE(violations(*map, route).empty()) << seed;
    EXPECT_GE(cost.along(route), (1.0 - 1e-9) * LowerBound()(map, places, 0.0)) << seed;
    EXPECT_TRUE(pointRoute(cost, places, 0.0, 0.5 * cost.along(route)).empty()) << "nothing half as dear";
  }
  EXPECT_GT(found, 8);
}

TEST(PointRoute, RouteEndsWithinTheTolerance) {
  const MotionCost cost(drawn({"......#", "......#", "......."}));
  const Polyline route = pointRoute(cost, {{0.4, 1.6}, {6.5, 1.5}}, 1.5, kInfinity);
  ASSERT_GE(route.size(), 2U);
  EXPECT_LE(std::hypot(route.back().x_m - 6.5, route.back().y_m - 1.5), 1.5);
  EXPECT_TRUE(std::isfinite(cost.along(route)));
}

// Property: on ground with two narrow arcs of headings, where routes tack, a prescribed via point on the
// route does not make the route substantially cheaper.
TEST(PointRoute, ViaPointsDoNotReduceTheCost) {
  int compared = 0;
  double worst = 1.0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Problem asked;
    asked.map = randomBand(seed, 0.14, 0.19);
    asked.start = {1.3, 1.2};
    asked.goal = {7.6, 7.4};
    asked.prove = true;
    FieldPlanner planner;
    const Plan plan = planner.plan(asked);
    if (plan.status != RouteStatus::Found) continue;
    EXPECT_TRUE(violations(*asked.map, plan.points).empty()) << seed;
    for (int k = 0; k < 9; ++k) {
      asked.via = {{2.4 + 2.1 * (k % 3), 2.4 + 2.1 * static_cast<double>(k / 3)}};
      const Plan over = planner.plan(asked);
      if (over.status != RouteStatus::Found) continue;
      ++compared;
      EXPECT_GE(over.cost_J, 0.99 * plan.cost_J) << seed << ' ' << k;
      worst = std::min(worst, over.cost_J / plan.cost_J);
    }
    asked.via.clear();
  }
  EXPECT_GT(compared, 50);
  RecordProperty("worst", std::to_string(worst));
}

}  // namespace point_route_test
}  // namespace talus::planner
