#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/refine/vertices.hpp>

#include "drawn_map.hpp"
#include "steered_ground.hpp"

namespace talus::planner {
namespace vertices_test {

TEST(CloseVertices, VerticesCloserThanAHundredthOfACellAreMerged) {
  const auto map = testing::drawn({".....", ".....", "....."});
  const MotionCost cost(map);
  const Polyline kept =
      withoutCloseVertices(cost, {{0.5, 0.5}, {2.5, 1.5}, {2.5 + 1e-8, 1.5}, {2.505, 1.5}, {4.5, 0.5}});
  EXPECT_EQ(kept.size(), 3U);
  const Polyline ends = withoutCloseVertices(cost, {{0.5, 0.5}, {0.501, 0.5}, {4.499, 0.5}, {4.5, 0.5}});
  EXPECT_EQ(ends, (Polyline{{0.5, 0.5}, {4.5, 0.5}}));
}

// Property: a vertex at the corner of a wall is not moved into the wall.
TEST(CloseVertices, MergedRouteIsValid) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto map =
        testing::randomMap({.width = 6, .height = 6, .seed = seed, .blocked = 0.2, .roughness = 0.3});
    const MotionCost cost(map);
    Polyline way{{0.5, 0.5}, {2.5, 2.5}, {2.504, 2.503}, {4.5, 3.5}, {4.5, 3.505}, {5.5, 5.5}};
    if (!std::isfinite(cost.along(way))) continue;
    const Polyline kept = withoutCloseVertices(cost, way);
    EXPECT_TRUE(std::isfinite(cost.along(kept)));
    EXPECT_EQ(kept.front(), way.front());
    EXPECT_EQ(kept.back(), way.back());
  }
}

using testing::drawn;

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

// Closed form: over level ground the straight line is the cheapest.
TEST(SettledVertices, RouteIsStraightOnUniformGround) {
  const MotionCost cost(drawn(std::vector<std::string>(8, std::string(20, '.'))));
  const Polyline made =
      withSettledVertices(cost, {{1.0, 4.0}, {4.0, 4.3}, {8.0, 3.8}, {12.0, 4.2}, {16.0, 4.0}});
  EXPECT_EQ(made.front(), (maps::Point{1.0, 4.0}));
  EXPECT_EQ(made.back(), (maps::Point{16.0, 4.0}));
  EXPECT_NEAR(cost.along(made), 150.0, 1e-2);  // straight: 15 m at 10 J; steps end at 0.0125 cells
}

// Property: the cost never increases, the route is allowed and the ends are kept, with turn costs and
// refused headings.
TEST(SettledVertices, CostNeverIncreases) {
  std::mt19937 random(7);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  int cheaper = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const MotionCost cost(withTurns(testing::randomDescent(static_cast<unsigned>(trial)), 10.0 * unit()));
    Polyline route{{4.5, 8.5}};
    while (route.back().y_m > 1.5)
      route.push_back({route.back().x_m + 0.6 * (unit() - 0.5), route.back().y_m - 0.3 - unit()});
    const double before_J = cost.along(route);
    if (!std::isfinite(before_J)) continue;
    const Polyline made = withSettledVertices(cost, route);
    EXPECT_LE(cost.along(made), before_J * (1.0 + 1e-12));
    EXPECT_EQ(made.front(), route.front());
    EXPECT_EQ(made.back(), route.back());
    cheaper += cost.along(made) < 0.999 * before_J;
  }
  EXPECT_GT(cheaper, 10);
}

// Closed form: on level ground the nearest point of a circle lies on the line to its centre.
TEST(SettledVertices, EndMovesToTheNearestPointWithinTolerance) {
  const MotionCost cost(drawn(std::vector<std::string>(12, std::string(20, '.'))));
  const maps::Point goal{15.0, 6.0};
  const double turned = 1.2;
  const Polyline made = withSettledEnd(
      cost, {{2.0, 6.0}, {goal.x_m - 3.0 * std::cos(turned), goal.y_m + 3.0 * std::sin(turned)}}, goal, 3.0);
  EXPECT_NEAR(cost.along(made), 100.0, 0.02);
  EXPECT_LE(distance_m(made.back(), goal), 3.0);
  const Polyline elsewhere{{2.0, 6.0}, {14.0, 6.5}};
  EXPECT_EQ(withSettledEnd(cost, elsewhere, goal, 3.0), elsewhere);
}

// A slope in the east that may only be driven down, southwards. A turn on the cell side needs both headings
// in both cells; just off the side, both headings are needed in one cell only.
TEST(SettledVertices, TurnsAreMovedOffCellSides) {
  maps::Raster<costmap::CellCode> cells({.width = 2, .height = 2, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.0, .dz_dy = 0.0, .curve = 0}));
  for (int row = 0; row < 2; ++row)
    cells[{1, row}] = costmap::CellCode({.dz_dx = 0.0, .dz_dy = 0.2, .curve = 0});
  const MotionCost cost(
      std::make_shared<const costmap::CostGrid>(costmap::flattened(cells, testing::onlyAlong(-1.0, 0.0))));
  const Polyline turns{{0.4, 1.2}, {1.0, 1.4}, {1.6, 1.1}};
  ASSERT_FALSE(std::isfinite(cost.along(turns)));
  const Polyline made = offSides(cost, turns);
  ASSERT_TRUE(std::isfinite(cost.along(made)));
  EXPECT_NEAR(made[1].x_m, 1.0, 0.03);
}

}  // namespace vertices_test
}  // namespace talus::planner
