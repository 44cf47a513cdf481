#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/refine/vertices.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace any_angle_test {

const Polyline kWindow{{0.0, 0.0}, {10.0, 4.0}}, kResult{{0.0, 0.0}, {5.0, 1.0}, {10.0, 4.0}};

// Closed form: the window's box, 0 to 10 by 0 to 4 m, grown by a reach of 2 m; corners in any order.
TEST(RefinementCache, WindowsNearChangedGroundAreDropped) {
  struct Case {
    Segment corners;
    bool forgotten;
  };
  for (const Case& c : {Case{{{12.1, 0.0}, {20.0, 4.0}}, false},
                        {{{20.0, 4.0}, {11.9, 0.0}}, true},
                        {{{-9.0, -9.0}, {20.0, -2.1}}, false},
                        {{{4.0, 6.1}, {5.0, 9.0}}, false},
                        {{{4.0, 9.0}, {5.0, 5.9}}, true},
                        {{{-99.0, -99.0}, {99.0, 99.0}}, true}}) {
    RefinementCache cache;
    cache.keep(kWindow, kResult, 2.0);
    cache.forget(c.corners);
    EXPECT_EQ(!cache.find(kWindow), c.forgotten) << c.corners.from.x_m << "," << c.corners.from.y_m;
  }
}

Polyline wave(double from_m, double to_m) {
  Polyline line;
  for (double x = from_m; x <= to_m; x += 1.0) line.push_back({x, 3.0 * std::sin(0.2 * x)});
  return line;
}

// A refinement that marks every window by moving its middle point.
Polyline lifted(const Polyline& window) {
  Polyline made = window;
  if (made.size() > 2) made[made.size() / 2].y_m += 1.0;
  return made;
}

constexpr WindowCut kCut{.length_m = 20.0, .overlap_m = 5.0, .reach_m = 2.0};

TEST(RouteWindows, ResultIsIndependentOfThreadsAndCache) {
  RefinementCache one, two, again;
  const Polyline route = wave(0.0, 200.0);
  const Polyline made = byWindows(route, kCut, lifted, one, 1);
  EXPECT_NE(made, route);
  EXPECT_EQ(made.front(), route.front());
  EXPECT_EQ(made.back(), route.back());
  EXPECT_EQ(made, byWindows(route, kCut, lifted, two, 2));
  byWindows(wave(50.0, 200.0), kCut, lifted, again, 1);
  EXPECT_EQ(made, byWindows(route, kCut, lifted, again, 1));
}

TEST(RouteWindows, UnchangedWindowsAreNotRecomputed) {
  RefinementCache memo;
  std::atomic<int> worked{0};
  const auto work = [&worked](const Polyline& window) {
    ++worked;
    return lifted(window);
  };
  const Polyline route = wave(0.0, 200.0);
  byWindows(route, kCut, work, memo, 2);
  const int whole = worked.exchange(0);
  EXPECT_GT(whole, 12);
  byWindows(route, kCut, work, memo, 2);
  EXPECT_EQ(worked.exchange(0), 0);
  memo.forget({{100.0, 0.0}, {101.0, 0.0}});  // inside one window, possibly within reach of a joint
  byWindows(route, kCut, work, memo, 2);
  const int part = worked.exchange(0);
  EXPECT_GE(part, 1);
  EXPECT_LE(part, 4);
  memo.forget({{300.0, 0.0}, {301.0, 0.0}});
  byWindows(route, kCut, work, memo, 2);
  EXPECT_EQ(worked.exchange(0), 0);
  memo.newRound();
  memo.newRound();
  byWindows(route, kCut, work, memo, 2);
  EXPECT_EQ(worked.exchange(0), whole);
}

TEST(RouteWindows, StopLeavesTheRouteUnchanged) {
  RefinementCache memo;
  std::stop_source source;
  source.request_stop();
  ProgressMonitor watch;
  watch.stop = source.get_token();
  const Polyline route = wave(0.0, 100.0);
  const Polyline made = byWindows(route, kCut, lifted, memo, 1, StopCheck(watch));
  EXPECT_NEAR(length_m(made), length_m(route), 1e-9);
}

using testing::drawn;
using testing::randomMap;

TEST(AnyAngle, RouteIsStraightOnFlatGround) {
  const MotionCost cost(drawn(std::vector<std::string>(40, std::string(60, '.'))));
  const std::vector<maps::Point> grid{{0.5, 0.5}, {30.5, 30.5}, {55.5, 30.5}};
  const auto route = Refiner()(cost, grid);
  // Closed form: on ground of one cost the straight line is best.
  EXPECT_NEAR(cost.along(route), 10.0 * std::hypot(55.0, 30.0), 1e-3);
  EXPECT_EQ(route.size(), 2U);
}

TEST(AnyAngle, RouteRefractsByTheLawOfSnell) {
  // Closed form: at the border of 10 and 30 J/m the sines of the angles to the normal have the ratio 3 to 1
  // (Snell).
  std::vector<std::string> rows(60, std::string(120, '.'));
  for (auto& row : rows) row.replace(60, 60, std::string(60, '2'));
  const MotionCost cost(drawn(rows));
  const maps::Point a{20.5, 10.5}, b{99.5, 50.5};
  double best = 1e9, best_y = 0.0;  // Closed form, by scanning where the border is crossed.
  for (double y = 10.5; y < 50.5; y += 1e-4) {
    const double J = 10 * std::hypot(60 - a.x_m, y - a.y_m) + 30 * std::hypot(b.x_m - 60, b.y_m - y);
    if (J < best) best = J, best_y = y;
  }
  const auto route = withSettledVertices(cost, Refiner()(cost, {a, {60.5, best_y + 3.0}, b}));
  EXPECT_NEAR(cost.along(route), best, 5e-4 * best);
}

// Property: the cost never increases, the ends are kept, and the route is allowed.
TEST(AnyAngle, CostNeverIncreases) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const MotionCost cost(
        randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.0, .roughness = 0.1}));
    const std::vector<maps::Point> grid{{1.5, 1.5}, {20.5, 1.5}, {20.5, 20.5}, {38.5, 38.5}};
    const double before = cost.along(grid);
    const auto route = Refiner()(cost, grid);
    EXPECT_LT(cost.along(route), before);
    EXPECT_EQ(route.front(), grid.front());
    EXPECT_EQ(route.back(), grid.back());
  }
}

}  // namespace any_angle_test

}  // namespace talus::planner
