#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/refine/fewer_turns.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace fewer_turns_test {

using testing::drawn;

TEST(FewerTurns, CollinearVerticesAreRemoved) {
  const MotionCost cost(drawn({".....", ".#...", "....."}));
  const auto route = withFewerTurns(cost, {{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}, {2.5, 2.5}});
  EXPECT_EQ(route.size(), 3U);
}

// Closed form, by brute force: the least cost over all subsets of the vertices of a path around an expensive
// area.
TEST(FewerTurns, CostMatchesTheBestSubsetOfVertices) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(0.6, 19.4);
  int fewer = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const MotionCost cost(testing::plane(20, {0.0, 0.0}, trial % 3 * 8.0));
    Polyline route;
    for (int k = 0; k < 4; ++k) route.push_back({place(random), place(random)});
    double least = std::numeric_limits<double>::infinity();
    for (int kept = 0; kept < 4; ++kept) {
      Polyline chosen{route[0]};
      if (kept & 1) chosen.push_back(route[1]);
      if (kept & 2) chosen.push_back(route[2]);
      chosen.push_back(route[3]);
      least = std::min(least, cost.along(chosen));
    }
    const Polyline made = withFewerTurns(cost, route);
    EXPECT_NEAR(cost.along(made), least, 1e-6);
    fewer += made.size() < route.size() ? 1 : 0;
  }
  EXPECT_EQ(fewer, 60) << "on even ground the straight line is best";
}

// Property: a detour is removed if it saves less than its turns cost, and kept if it saves more.
TEST(FewerTurns, DetourIsKeptOnlyIfItSavesMoreThanItsTurnsCost) {
  std::vector<std::string> rows(5, std::string(20, '.'));
  rows[4].replace(8, 4, "2222");
  const Polyline around{{0.5, 0.5}, {8.0, 1.5}, {12.0, 1.5}, {19.5, 0.5}};
  const auto priced = [&](double turn_J) { return testing::withTurns(drawn(rows), turn_J); };
  EXPECT_EQ(withFewerTurns(MotionCost(priced(1.0)), around).size(), 3U) << "past one corner of the field";
  EXPECT_EQ(withFewerTurns(MotionCost(priced(2000.0)), around).size(), 2U);
}

}  // namespace fewer_turns_test
}  // namespace talus::planner
