#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <talus/common/constants.hpp>
#include <talus/planner/grid/many_headings.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace many_headings_test {

using testing::drawn;
using testing::randomMap;

// The cheapest route between centres in the same headings, by Bellman-Ford over MotionCost.
double bruteForce(const MotionCost& cost, maps::Cell from, maps::Cell to) {
  const maps::Grid& grid = cost.map().grid();
  std::vector<double> best(grid.size(), kInfinity);
  best[grid.index(from)] = 0.0;
  for (bool moved = true; moved;) {
    moved = false;
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column)
        for (int dr = -3; dr <= 3; ++dr)
          for (int dc = -3; dc <= 3; ++dc) {
            const maps::Cell next{column + dc, row + dr};
            const double here = best[grid.index({column, row})];
            if (!(here < kInfinity) || !grid.contains(next) || (dr == 0 && dc == 0)) continue;
            const double through = here + cost({grid.centre({column, row}), grid.centre(next)});
            if (!(through < best[grid.index(next)] - 1e-7)) continue;
            best[grid.index(next)] = through;
            moved = true;
          }
  }
  return best[grid.index(to)];
}

TEST(ManyHeadings, CostMatchesBruteForce) {
  int found = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const MotionCost cost(
        randomMap({.width = 9, .height = 8, .seed = seed, .blocked = 0.15, .roughness = 0.2}));
    const Segment places{cost.map().grid().centre({0, 0}), cost.map().grid().centre({8, 7})};
    if (!cost.allowed(places.from) || !cost.allowed(places.to)) continue;
    const double least = bruteForce(cost, {0, 0}, {8, 7});
    const Polyline route = manyHeadingsRoute(cost, places, 0.0, kInfinity);
    ASSERT_EQ(route.empty(), !(least < kInfinity)) << seed;
    if (route.empty()) continue;
    ++found;
    EXPECT_EQ(route.front(), places.from);
    EXPECT_EQ(route.back(), places.to);
    EXPECT_NEAR(cost.ofLegs(route), least, 1e-4 * least) << seed;
    EXPECT_TRUE(manyHeadingsRoute(cost, places, 0.0, 0.99 * least).empty()) << "nothing cheaper";
  }
  EXPECT_GT(found, 8);
}

TEST(ManyHeadings, RouteEndsWithinTheTolerance) {
  const MotionCost cost(drawn({"......#", "......#", "......."}));
  const Polyline route = manyHeadingsRoute(cost, {{0.4, 1.6}, {6.5, 1.5}}, 1.5, kInfinity);
  ASSERT_GE(route.size(), 2U);
  EXPECT_LE(std::hypot(route.back().x_m - 6.5, route.back().y_m - 1.5), 1.5);
  EXPECT_TRUE(std::isfinite(cost.along(route)));
}

}  // namespace many_headings_test
}  // namespace talus::planner
