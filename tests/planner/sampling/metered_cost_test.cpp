#include <cmath>
#include <random>

#include <talus/planner/sampling/metered_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace metered_cost_test {

using testing::drawn;
using testing::randomMap;

// Property: the value is that of MotionCost if a route may turn at both ends, else infinite. Finite motions
// joined at any such place form an allowed route.
TEST(MeteredCost, CostEqualsMotionCostAtValidTurns) {
  const auto map = randomMap({.seed = 4, .blocked = 0.1, .roughness = 0.3});
  const MotionCost exact(map);
  const MeteredCost cost(map, {{0.5, 0.5}, {19.5, 19.5}});
  std::mt19937 random(2);
  // Multiples of half a metre: half of the places lie on an edge, a quarter on a corner.
  const auto place = [&random] {
    return maps::Point{0.5 * static_cast<double>(random() % 41), 0.5 * static_cast<double>(random() % 41)};
  };
  int finite = 0, joined = 0;
  for (int k = 0; k < 20'000; ++k) {
    const maps::Point a = place(), b{a.x_m + 0.5 * static_cast<double>(random() % 5), a.y_m + 0.5},
                      c = place();
    const double first = cost({a, b}), second = cost({b, c});
    if (!std::isfinite(first)) continue;
    ++finite;
    EXPECT_EQ(first, exact({a, b}));
    if (!std::isfinite(second)) continue;
    ++joined;
    EXPECT_TRUE(std::isfinite(exact.along({a, b, c})));
  }
  EXPECT_GT(finite, 1'000);
  EXPECT_GT(joined, 20);
}

// Closed form: a call counts one plus the cells of its length, 1 + 3 for 3.5 m; an immediate repetition
// counts nothing, an iteration a hundred.
TEST(MeteredCost, WorkCountsCellLengths) {
  const MeteredCost cost(drawn({".....", "....."}), {{0.5, 0.5}, {4.5, 0.5}});
  EXPECT_EQ(cost.work(), 0U);
  EXPECT_NEAR(cost({{0.5, 0.5}, {4.0, 0.5}}), 35.0, 1e-6);
  EXPECT_EQ(cost.work(), 4U);
  EXPECT_NEAR(cost({{0.5, 0.5}, {4.0, 0.5}}), 35.0, 1e-6);
  EXPECT_EQ(cost.work(), 4U);
  cost({{4.0, 0.5}, {0.5, 0.5}});
  cost.iterated();
  EXPECT_EQ(cost.work(), 108U);
}

// Property: start and goal of the problem are no turns and may lie on an edge beside blocked ground.
TEST(MeteredCost, StartAndGoalAreNotTreatedAsTurns) {
  const auto map = drawn({"##", ".."});
  const Segment up{{0.5, 1.0}, {1.5, 0.5}};
  EXPECT_TRUE(std::isinf(MeteredCost(map, {{0.1, 0.1}, {1.9, 0.1}})(up)));
  EXPECT_TRUE(std::isfinite(MotionCost(map)(up)));
  EXPECT_EQ(MeteredCost(map, {up.from, up.to})(up), MotionCost(map)(up));
}

}  // namespace metered_cost_test
}  // namespace talus::planner
