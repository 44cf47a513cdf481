#include <cmath>

#include <gtest/gtest.h>

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

// Property: the refined route depends neither on the number of threads nor on kept results.
TEST(AnyAngle, RouteIsIndependentOfThreadsAndKeptResults) {
  const MotionCost cost(randomMap({.width = 500, .height = 40, .seed = 3, .blocked = 0.0, .roughness = 0.1}));
  Polyline wave, shifted;
  for (double x = 5.5; x < 495.0; x += 1.0) {
    wave.push_back({x, 20.5 + 12.0 * std::sin(0.05 * x)});
    shifted.push_back({x, x < 200.0 ? wave.back().y_m : 20.5});
  }
  const Polyline made = Refiner()(cost, wave);
  EXPECT_LT(cost.along(made), cost.along(wave));
  Refiner kept;
  kept(cost, shifted);
  EXPECT_EQ(kept(cost, wave, 2), made);
  kept.forget({{100.0, 20.0}, {101.0, 21.0}});
  EXPECT_EQ(kept(cost, wave, 2), made);
}

}  // namespace any_angle_test

}  // namespace talus::planner
