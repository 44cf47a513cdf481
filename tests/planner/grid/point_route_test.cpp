#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/point_route.hpp>

#include "steered_ground.hpp"

namespace talus::planner {
namespace point_route_test {

using testing::drawn;
using testing::randomBand;

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
