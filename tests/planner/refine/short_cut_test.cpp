#include <cmath>
#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/refine/short_cut.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace short_cut_test {

using testing::drawn;
using testing::randomMap;

// Closed form: on level ground the straight line is optimal, and a motion over all sections is among the
// candidates.
TEST(ShortCut, ZigzagOnUniformGroundBecomesStraight) {
  const MotionCost cost(drawn(std::vector<std::string>(20, std::string(70, '.'))));
  Polyline zigzag;
  for (int k = 0; k <= 16; ++k) zigzag.push_back({2.5 + 4.0 * k, k % 2 == 0 ? 5.5 : 12.5});
  const Polyline made = shortCut(cost, zigzag, 100.0);
  EXPECT_NEAR(cost.along(shortCut(cost, zigzag, 2.0)), 640.0, 0.05 * 640.0);
  EXPECT_EQ(made, (Polyline{zigzag.front(), zigzag.back()}));
}

// Property: the cost never increases, the ends are kept, and the cost decreases on some ground; a cheap
// detour is kept.
TEST(ShortCut, CostNeverIncreases) {
  double saved = 0.0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const MotionCost cost(
        randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.0, .roughness = 0.15}));
    const Polyline route{{1.5, 1.5}, {12.4, 3.3}, {20.5, 16.5}, {22.7, 30.1}, {38.5, 38.5}};
    const double before_J = cost.along(route);
    if (!std::isfinite(before_J)) continue;
    const Polyline made = shortCut(cost, route, 3.0);
    EXPECT_LE(cost.along(made), before_J * (1 + 1e-9)) << seed;
    EXPECT_EQ(made.front(), route.front());
    EXPECT_EQ(made.back(), route.back());
    saved += before_J - cost.along(made);
  }
  EXPECT_GT(saved, 100.0);
  std::vector<std::string> rows(12, std::string(40, '4'));
  rows[0] = std::string(40, '.');
  const MotionCost dear_inside(drawn(rows));
  const Polyline detour{{1.5, 11.5}, {20.5, 11.5}, {38.5, 11.5}};
  EXPECT_NEAR(dear_inside.along(shortCut(dear_inside, detour, 3.0)), 370.0, 1e-3);
}

TEST(ShortCut, StopLeavesTheRouteUnchanged) {
  const MotionCost cost(drawn({".....", "....."}));
  std::stop_source source;
  source.request_stop();
  const Polyline route{{0.5, 0.5}, {2.5, 1.5}, {4.5, 0.5}};
  EXPECT_EQ(shortCut(cost, route, 1.0, ProgressMonitor{.progress = {}, .stop = source.get_token()}), route);
}

TEST(ShortCut, CollinearVerticesAreRemoved) {
  const MotionCost cost(drawn({".....", ".#...", "....."}));
  const auto route = withoutIdleTurns(cost, {{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}, {2.5, 2.5}});
  EXPECT_EQ(route.size(), 3U);
}

}  // namespace short_cut_test
}  // namespace talus::planner
