#include <cmath>

#include <ompl/geometric/PathGeometric.h>

#include <talus/planner/sampling/ompl_guard.hpp>
#include <talus/planner/sampling/seeded_rrt_star.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
namespace seeded_rrt_star_test {

namespace ob = ompl::base;

const Segment kEnds{{2.5, 10.5}, {27.5, 10.5}};

// Cost of the solution of a planner with this seed route after a number of iterations.
double costAfter(int rounds, const SeededRRTstar::Seed& seed) {
  const QuietOmpl quiet;
  const testing::OmplGround ground(testing::drawn(std::vector<std::string>(20, std::string(30, '.'))), kEnds);
  double cost_J = INFINITY;
  withOmplSeed(1, [&] {
    SeededRRTstar planner(ground.space, seed);
    planner.setRange(8.0);
    planner.setProblemDefinition(ground.definition);
    planner.setup();
    int round = 0;
    planner.solve(ob::PlannerTerminationCondition([&] { return round++ >= rounds; }));
    const auto path = ground.definition->getSolutionPath();
    if (path && ground.definition->hasExactSolution())
      cost_J = path->cost(ground.definition->getOptimizationObjective()).value();
  });
  return cost_J;
}

// Closed form: the seed's three legs at 10 J/m are the first solution; the cost never increases, and
// decreases with time.
TEST(SeededRRTstar, SeedRouteIsAvailableImmediatelyAndImproved) {
  const std::vector<maps::Point> known{kEnds.from, {10.5, 18.5}, {20.5, 3.5}, kEnds.to};
  double seed_J = 0.0;
  for (std::size_t i = 1; i < known.size(); ++i)
    seed_J += 10.0 * std::hypot(known[i].x_m - known[i - 1].x_m, known[i].y_m - known[i - 1].y_m);
  for (const bool informed : {false, true}) {
    const SeededRRTstar::Seed seed{.route = known, .spacing_m = 2.0, .informed = informed};
    EXPECT_NEAR(costAfter(1, seed), seed_J, 0.01 * seed_J);
    const double improved_J = costAfter(2'000, seed);
    EXPECT_LT(improved_J, 0.9 * seed_J);
    EXPECT_GE(improved_J, 250.0 - 1e-3);  // the straight line
  }
  EXPECT_TRUE(std::isinf(costAfter(1, {})));  // without a seed nothing is known yet
}

// Property: a seed that does not reach the goal is extended, and is no solution.
TEST(SeededRRTstar, SeedThatMissesTheGoalIsNoSolution) {
  EXPECT_TRUE(std::isinf(costAfter(1, {.route = {kEnds.from, {20.5, 10.5}}, .spacing_m = 2.0})));
}

}  // namespace seeded_rrt_star_test
}  // namespace talus::planner
