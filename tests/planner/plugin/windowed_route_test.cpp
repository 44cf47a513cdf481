#include <algorithm>
#include <cmath>

#include <talus/planner/plugin/windowed_route.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "rolling_ground.hpp"

namespace talus::planner {
namespace windowed_route_test {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(WindowedRoute, IsThatOfTheWholeMapWithinAFewPercent) {
  int asked = 0;
  WindowedMap map = windows(asked);
  PlanRequest request;
  request.start = {150.0, 0.0};
  request.goal = {1400.0, 850.0};
  const Route route = routeInWindows(request, map);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_TRUE(
      std::ranges::all_of(route.vertices, [](const auto& v) { return std::isfinite(v.elevation_m); }));
  // Property: the whole map allows it at the same price.
  std::vector<maps::Point> points;
  for (const RouteVertex& v : route.vertices) points.push_back({v.x_m, v.y_m});
  const double price_J = MotionCost(built(kWhole).published()).along(points);
  EXPECT_NEAR(price_J, route.summary.cost, 1e-6 * price_J);
}

TEST(WindowedRoute, SaysWhatItCannotDo) {
  int asked = 0;
  WindowedMap map = windows(asked);
  EXPECT_THAT([&] { routeInWindows({}, map, {.planner = "hybrid"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'hybrid' does not plan in windows")));
  PlanRequest request;
  request.start_heading_rad = 0.0;
  EXPECT_THAT([&] { routeInWindows(request, map); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad")));
  EXPECT_THROW(routeInWindows({}, map, {.threads = 0}), std::invalid_argument);
  EXPECT_EQ(asked, 0);  // nothing was built for a request that is refused
}

}  // namespace windowed_route_test
}  // namespace talus::planner
