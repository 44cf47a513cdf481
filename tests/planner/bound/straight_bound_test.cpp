#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <talus/planner/bound/straight_bound.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace straight_bound_test {

using testing::drawn;

// Closed form: the minimum over the curves that occur in cells: 10 J times the number of the curve plus one.
TEST(CheapestMetre, MinimumIsTakenOverCurvesInUse) {
  EXPECT_NEAR(cheapestMetre_J(*drawn({"234", "#?4"})), 30.0, 1e-5);
  EXPECT_NEAR(cheapestMetre_J(*drawn({"4.4"})), 10.0, 1e-5);
  EXPECT_EQ(cheapestMetre_J(*drawn({"#?"})), 0.0);
}

// Closed form: 10 J/m on level ground in every direction; the cheaper gradients of a ramp elsewhere do not
// count.
TEST(StraightBound, BoundEqualsStraightLineCostOnUniformGround) {
  const auto map = drawn(std::vector<std::string>(60, std::string(60, '.')));
  for (int k = 0; k < 24; ++k) {
    const double angle = 0.2618 * k + 0.1;
    const Segment ends{{30.2, 29.7}, {30.2 + 25.0 * std::cos(angle), 29.7 + 25.0 * std::sin(angle)}};
    const double cost_J = MotionCost(map)(ends);
    EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0, cost_J), cost_J, 1e-6 * cost_J) << k;
    EXPECT_NEAR(straightBoundOver_J(*map, ends, 5.0, cost_J), 0.8 * cost_J, 1e-6 * cost_J) << k;
    EXPECT_LE(straightBound_J(*map, ends), straightBoundOver_J(*map, ends, 0.0)) << k;
  }
}

// Closed form: 30 J/m; ground of 10 J/m lies so far aside that reaching it costs more than the straight
// line.
TEST(StraightBound, CheapGroundOutOfReachIsExcluded) {
  std::vector<std::string> rows(120, std::string(120, '2'));
  for (int k = 0; k < 20; ++k)
    rows[static_cast<std::size_t>(k)].replace(100, 20, std::string(20, '.'));  // north-east
  const auto map = drawn(rows);
  const Segment ends{{10.5, 10.5}, {30.5, 20.5}};
  const double cost_J = MotionCost(map)(ends);
  EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0, cost_J), cost_J, 1e-6 * cost_J);
  EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0), cost_J, 1e-6 * cost_J);
}

// Closed form: a track of 10 J/m begins 3 m behind the start and ends 3 m behind the goal. The detour over
// ground of 50 J/m at both ends and the track is cheaper than the straight line of 1000 J.
TEST(StraightBound, CheapTrackBehindTheStartIsIncluded) {
  std::vector<std::string> rows(60, std::string(100, '4'));
  const auto track = [&rows](int column, int y) {
    rows[static_cast<std::size_t>(59 - y)][static_cast<std::size_t>(column)] = '.';
  };
  for (int y = 30; y <= 48; ++y) track(37, y), track(63, y);
  for (int column = 37; column <= 63; ++column) track(column, 48);
  const auto map = drawn(rows);
  const Segment ends{{40.5, 30.5}, {60.5, 30.5}};
  const MotionCost cost(map);
  const double round_J =
      cost.along({ends.from, {37.5, 30.5}, {37.5, 48.5}, {63.5, 48.5}, {63.5, 30.5}, ends.to});
  ASSERT_LT(round_J, cost(ends));
  EXPECT_LE(straightBoundOver_J(*map, ends, 0.0), round_J);
  EXPECT_LE(straightBoundOver_J(*map, ends, 0.0, cost(ends)), round_J);
}

// Property: for any known route, no random motion through any third place costs less than the bound.
TEST(StraightBound, BoundIsBelowEveryMotionForAnyKnownRoute) {
  std::size_t tried = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto map = testing::randomMap(
        {.width = 40, .height = 30, .seed = seed, .blocked = 0.0, .roughness = 0.01 * (seed % 8)});
    const MotionCost cost(map);
    std::mt19937 random(seed);
    const auto place = [&random] {
      return maps::Point{static_cast<double>(random() % 401) / 10, static_cast<double>(random() % 301) / 10};
    };
    const Segment ends{place(), place()};
    std::vector<double> costs;
    for (int k = 0; k < 100; ++k)
      if (const double cost_J = cost.along({ends.from, place(), ends.to}); std::isfinite(cost_J))
        costs.push_back(cost_J);
    if (const double cost_J = cost(ends); std::isfinite(cost_J)) costs.push_back(cost_J);
    if (costs.empty()) continue;
    const double least_J = *std::min_element(costs.begin(), costs.end());
    for (const double known_J : costs)
      EXPECT_LE(straightBoundOver_J(*map, ends, 0.0, known_J), least_J * (1 + 1e-9)) << seed;
    tried += costs.size();
  }
  EXPECT_GT(tried, 500U);
}

}  // namespace straight_bound_test
}  // namespace talus::planner
