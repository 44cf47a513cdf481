#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/refine/longer_tacks.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace longer_tacks_test {

using testing::drawn;
using testing::withTurns;

Polyline zigzag(int tacks) {
  Polyline points{{1.3, 1.2}};
  for (int k = 0; k < tacks; ++k)
    points.push_back({points.back().x_m + 0.5, points.back().y_m + (k % 2 ? -0.4 : 0.9)});
  return points;
}

// Closed form: on level ground two legs that add up to the zigzag and one turn remain; the length is
// unchanged.
TEST(LongerTacks, ZigzagOnUniformGroundIsReducedToOneTurn) {
  const MotionCost cost(withTurns(drawn(std::vector<std::string>(20, std::string(30, '.'))), 5.0));
  const Polyline route = zigzag(24), made = withLongerTacks(cost, route);
  ASSERT_EQ(made.size(), 3U);
  EXPECT_EQ(made.front(), route.front());
  EXPECT_EQ(made.back(), route.back());
  double before_m = 0.0, after_m = 0.0;
  for (std::size_t k = 1; k < route.size(); ++k) before_m += distance_m(route[k - 1], route[k]);
  for (std::size_t k = 1; k < made.size(); ++k) after_m += distance_m(made[k - 1], made[k]);
  EXPECT_NEAR(after_m, before_m, 1e-9);
}

// Property: the cost never increases, the ends are kept, and the route is allowed, among blocked cells and
// cells of many costs.
TEST(LongerTacks, CostNeverIncreases) {
  std::mt19937 random(5);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  int shorter = 0, allowed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::string> rows(20, std::string(30, '.'));
    for (auto& row : rows)
      for (char& cell : row)
        if (unit() < 0.15) cell = unit() < 0.2 ? '#' : '2';
    const MotionCost cost(withTurns(drawn(rows), 10.0 * unit()));
    Polyline route{{1.5, 10.5}};
    while (route.back().x_m < 27.0)
      route.push_back(
          {route.back().x_m + 0.2 + unit(), std::clamp(route.back().y_m + 2.0 * unit() - 1.0, 1.0, 19.0)});
    const double before_J = cost.along(route);
    if (!std::isfinite(before_J)) continue;
    ++allowed;
    const Polyline made = withLongerTacks(cost, route);
    EXPECT_LE(cost.along(made), before_J);
    EXPECT_EQ(made.front(), route.front());
    EXPECT_EQ(made.back(), route.back());
    shorter += made.size() < route.size();
  }
  EXPECT_GT(allowed, 20);
  EXPECT_GT(shorter, allowed / 2);
}

}  // namespace longer_tacks_test
}  // namespace talus::planner
