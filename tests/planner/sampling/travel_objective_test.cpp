#include <cmath>

#include <talus/planner/sampling/travel_objective.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
namespace travel_objective_test {

// Closed form: uphill at 205/1024 (drawn_map.hpp) a metre costs 100 g more than downhill; between nodes a
// parabola of 400 is off by 400 / 4 / 256^2. A blocked motion has the maximum cost.
TEST(TravelObjective, CostDependsOnDirectionAndBlockedMotionIsMaximal) {
  const testing::OmplGround ramp(testing::drawn({">>>>#", ">>>>#"}), {{0.5, 0.5}, {3.5, 0.5}});
  const auto low = ramp.at({0.5, 0.5}), high = ramp.at({2.5, 0.5}), wall = ramp.at({4.5, 0.5});
  const double g = 205.0 / 1024, down_J = 2 * (10 + 400 * g * g);
  EXPECT_NEAR(ramp.objective->motionCost(low.get(), high.get()).value(), down_J + 200 * g, 0.0032);
  EXPECT_NEAR(ramp.objective->motionCost(high.get(), low.get()).value(), down_J, 0.0032);
  EXPECT_EQ(ramp.objective->motionCost(low.get(), wall.get()).value(), kBlockedMotionCost_J);
  EXPECT_FALSE(ramp.objective->isSymmetric());
  EXPECT_EQ(ramp.objective->stateCost(low.get()).value(), 0.0);
}

// Property: the heuristics are admissible, and every sum of allowed motions is below the cost of a blocked
// motion.
TEST(TravelObjective, HeuristicsAreAdmissible) {
  const Segment ends{{1.5, 1.5}, {17.5, 16.5}};
  const testing::OmplGround on(testing::randomMap({.seed = 6, .blocked = 0.05, .roughness = 0.2}), ends);
  const auto goal = on.at(ends.to), start = on.at(ends.from);
  int tried = 0;
  for (int k = 0; k < 400; ++k) {
    const auto from = on.at({0.5 + k % 20, 0.5 + k / 20}),
               to = on.at({0.5 + (k * 7 + 3) % 20, 0.5 + (k * 3) % 20});
    for (const auto& [a, b] : {std::pair{&from, &to}, {&from, &goal}, {&start, &to}}) {
      const double exact_J = on.objective->motionCost(a->get(), b->get()).value();
      EXPECT_LE(on.objective->motionCostHeuristic(a->get(), b->get()).value(), exact_J * (1 + 1e-9));
      EXPECT_LE(exact_J, kBlockedMotionCost_J);
      tried += exact_J < kBlockedMotionCost_J;
    }
    EXPECT_LE(on.objective->costToGo(from.get(), nullptr).value(),
              on.objective->motionCost(from.get(), goal.get()).value() * (1 + 1e-9));
  }
  EXPECT_GT(tried, 100);
}

}  // namespace travel_objective_test
}  // namespace talus::planner
