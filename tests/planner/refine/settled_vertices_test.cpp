#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/refine/settled_vertices.hpp>

#include "steered_ground.hpp"

namespace talus::planner {
namespace settled_vertices_test {

using testing::drawn;
using testing::withTurns;

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

}  // namespace settled_vertices_test
}  // namespace talus::planner
