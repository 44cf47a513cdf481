#include <cmath>
#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/refine/station_shift.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace station_shift_test {

using testing::drawn;
using testing::randomMap;

// Property: the cost never increases, the route is allowed, the ends are kept, and the cost decreases on
// some ground.
TEST(StationShift, CostNeverIncreases) {
  double saved = 0.0;
  int shifted_routes = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const MotionCost cost(
        randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.02, .roughness = 0.1}));
    const Polyline route{{1.5, 1.5}, {14.4, 9.3}, {22.7, 20.1}, {38.5, 38.5}};
    const double before_J = cost.along(route);
    if (!std::isfinite(before_J)) continue;
    ++shifted_routes;
    const Polyline made = shifted(cost, route, 8.0);
    EXPECT_LE(cost.along(made), before_J * (1 + 1e-9)) << seed;
    EXPECT_EQ(made.front(), route.front());
    EXPECT_EQ(made.back(), route.back());
    saved += before_J - cost.along(made);
  }
  EXPECT_GT(shifted_routes, 3);
  EXPECT_GT(saved, 10.0);
}

// Property: the route moves onto a road of 10 J/m beside ground of 50 J/m, at most candidates * 0.98 * piece
// / candidates to the side.
TEST(StationShift, RouteMovesOntoAdjacentCheapGround) {
  std::vector<std::string> rows(21, std::string(60, '4'));
  rows[6] = rows[7] = std::string(60, '.');  // 3 to 5 m north of the route
  const MotionCost cost(drawn(rows));
  const Polyline route{{1.5, 10.5}, {58.5, 10.5}};
  const Polyline made = shifted(cost, route, 8.0, {.candidates = 8, .swing = 8});
  EXPECT_LT(cost.along(made), 0.5 * cost.along(route));
  for (const maps::Point p : made) EXPECT_LE(std::abs(p.y_m - 10.5), 8.0);
  // Closed form: without sideways candidates the cost is unchanged.
  EXPECT_NEAR(cost.along(shifted(cost, route, 8.0, {.candidates = 8, .swing = 0})), cost.along(route), 1e-6);
}

TEST(StationShift, StraightLineAndStoppedRouteAreUnchanged) {
  const MotionCost cost(drawn(std::vector<std::string>(20, std::string(50, '.'))));
  const Polyline route{{1.5, 10.5}, {48.5, 10.5}};
  EXPECT_NEAR(length_m(shifted(cost, route, 8.0)), 47.0, 1e-9);
  std::stop_source source;
  source.request_stop();
  const Polyline bent{{1.5, 10.5}, {20.5, 18.5}, {48.5, 10.5}};
  EXPECT_EQ(shifted(cost, bent, 8.0, {}, ProgressMonitor{.progress = {}, .stop = source.get_token()}), bent);
}

}  // namespace station_shift_test
}  // namespace talus::planner
