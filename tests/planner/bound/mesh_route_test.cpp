#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/many_headings.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace mesh_route_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Waves of two lengths with scattered blocked cells.
std::shared_ptr<const costmap::CostGrid> hills(unsigned seed) {
  maps::Raster<costmap::CellCode> cells(
      {.width = 40, .height = 30, .resolution_m = 1.0, .south_west = {12.0, -7.0}});
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  const double p = 6.0 * unit(), q = 6.0 * unit(), steep = 0.1 + 0.1 * unit();
  for (int row = 0; row < 30; ++row)
    for (int column = 0; column < 40; ++column)
      cells[{column, row}] = costmap::CellCode(
          {.dz_dx = steep * std::sin(0.45 * column + 0.2 * row + p),
           .dz_dy = steep * std::cos(0.6 * row - 0.3 * column + q),
           .curve = unit() < 0.04 ? costmap::CellCode::kBlocked : static_cast<std::uint8_t>(2)});
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
}

double legs_J(const MotionCost& cost, const Polyline& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += cost({points[i - 1], points[i]});
  return sum;
}

// Property: the route leads from start to goal over allowed ground, costs at least the proven bound, and
// costs on average less than the cheapest route in 32 headings, both unrefined.
TEST(MeshRoute, RouteIsCheaperThanWithThirtyTwoHeadings) {
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto map = hills(seed);
    const Segment places{{14.3, -4.6}, {49.8, 20.1}};
    const MotionCost cost(map);
    LowerBound bound;
    const double bound_J = bound(map, places, 0.0);
    const Polyline& way = bound.way();
    if (way.empty()) continue;
    EXPECT_EQ(way.front(), places.from);
    EXPECT_EQ(way.back(), places.to);
    const double along_J = legs_J(cost, way);
    EXPECT_GE(along_J, bound_J);
    const Polyline in_few = manyHeadingsRoute(cost, places, 0.0, kInfinity);
    if (in_few.size() > 1) ratios.push_back(along_J / legs_J(cost, in_few));
  }
  ASSERT_GT(ratios.size(), 15U);
  std::ranges::sort(ratios);
  EXPECT_LT(ratios[ratios.size() / 2], 1.0);
}

// Property: a start enclosed by refused ground has an empty route.
TEST(MeshRoute, UnreachableGoalYieldsAnEmptyRoute) {
  maps::Raster<costmap::CellCode> cells({.width = 12, .height = 9, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.curve = 2}));
  for (int row = 0; row < 9; ++row)
    cells[{6, row}] = costmap::CellCode({.curve = costmap::CellCode::kBlocked});
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
  LowerBound bound;
  bound(map, {{1.5, 4.5}, {10.5, 4.5}}, 0.0);
  EXPECT_TRUE(bound.way().empty());
}

}  // namespace mesh_route_test
}  // namespace talus::planner
