#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution.hpp>
#include <talus/planner/grid/point_route.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace sub_solution_test {

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

// Input on the whole map, with the lower bounds of level 1 from the start.
SubSolution::Parts partsOf(const MapPointer& map, const Segment& places,
                           double most_J = std::numeric_limits<double>::infinity()) {
  FittedOctagons octagons(map->cost());
  const auto octagon_of = [&](maps::Cell cell) { return octagons.of(map->at(cell)); };
  const maps::Cell start = *map->grid().cellAt(places.from);
  std::vector<FieldGoal> corners;
  for (const int row : {start.row, start.row + 1})
    for (const int column : {start.column, start.column + 1}) corners.push_back({{column, row}, 0.0});
  return {.map = map,
          .places = places,
          .most_J = most_J,
          .cheapest_J = cheapestMetre_J(*map),
          .from_start = cornerField(map, octagon_of, corners, {}, RouteSense::FromStart)};
}

// A sub-solution by a search that takes at most `quota` nodes and checks.
struct Solved {
  explicit Solved(const SubSolution::Parts& parts, std::size_t quota = ~std::size_t{0})
      : limits(parts.map->cost()), u(parts, limits, quota, {}) {}
  DirectionalCostBounds limits;
  SubSolution u;
};

MapPointer randomGround(unsigned seed, const std::shared_ptr<const costmap::TravelCost>& cost) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  maps::Raster<costmap::CellCode> cells(
      {.width = 24, .height = 17, .resolution_m = 2.0, .south_west = {-7.0, 3.0}});
  for (auto& cell : cells.values())
    cell = costmap::CellCode({.dz_dx = 0.3 * (2 * unit() - 1),
                              .dz_dy = 0.3 * (2 * unit() - 1),
                              .curve = unit() < 0.1 ? costmap::CellCode::kBlocked
                                                    : static_cast<costmap::CellCode::Curve>(5 * unit())});
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
}

// Property: in each triangle and random heading, the slope of the solution, divided by its excess, is at
// most the cost of a metre. The gradient is that of a plane through the three nodes.
TEST(SubSolution, SlopeIsBoundedByTheCostInAllHeadings) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto map = randomGround(seed, seed % 2 == 0 ? testing::jaggedCost() : testing::driveCost());
    const SubSolution::Parts parts = partsOf(map, {{-3.3, 5.1}, {39.7, 35.2}});
    if (!MotionCost(map).allowed(parts.places.to)) continue;
    const Solved solved(parts);
    const SubSolution& solution = solved.u;
    const Proof proof = provenBy(solution, parts);
    std::mt19937 random(seed);
    int triangles = 0;
    for (int row = 0; row < 17; ++row)
      for (int column = 0; column < 24; ++column) {
        const costmap::CellCode code = map->at({column, row});
        const CellMesh::Nodes nodes = solution.mesh().nodesOf({column, row});
        for (std::size_t k = 0; k < 4; ++k) {
          const std::array<std::uint32_t, 3> corners{nodes[k], nodes[(k + 1) % 4], nodes[4]};
          if (solution.pricesOf({column, row}) == nullptr) continue;
          if (!solution.inner(corners[0]) && !solution.inner(corners[1]) && !solution.inner(corners[2]))
            continue;
          const auto value = [&](std::size_t i) { return static_cast<double>(solution.at(corners[i])); };
          const auto place = [&](std::size_t i) { return solution.mesh().placeOf(corners[i]); };
          const double ax = place(1).x_m - place(0).x_m, ay = place(1).y_m - place(0).y_m,
                       bx = place(2).x_m - place(0).x_m, by = place(2).y_m - place(0).y_m;
          const double a = value(1) - value(0), b = value(2) - value(0), det = ax * by - ay * bx;
          const double gx = (a * by - b * ay) / det, gy = (b * ax - a * bx) / det;
          for (int n = 0; n < 60; ++n) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(random()) / 4294967296.0;
            const costmap::Direction d{std::cos(angle), std::sin(angle)};
            const auto price = static_cast<double>(map->cost().costPerMetre(code, d));
            ASSERT_LE(-(gx * d.x + gy * d.y) / proof.excess, price * (1.0 + 1e-9)) << seed << " " << angle;
          }
          ++triangles;
        }
      }
    EXPECT_GT(triangles, 0);
    EXPECT_LT(proof.excess, 1.01);
  }
}

// The least cost of a drive over a plane: along one heading, or along two of 720 headings in turn.
double leastOnPlane_J(const costmap::TravelCost& cost, costmap::CellCode code, const Segment& ends) {
  const double length_m = distance_m(ends.from, ends.to);
  const auto at = directionOf(ends);
  std::vector<costmap::Direction> headings;
  for (int k = 0; k < 720; ++k)
    headings.push_back({std::cos(std::numbers::pi / 360.0 * k), std::sin(std::numbers::pi / 360.0 * k)});
  auto least = static_cast<double>(cost.costPerMetre(code, at));
  for (const auto& a : headings)
    for (const auto& b : headings) {
      const double det = a.x * b.y - a.y * b.x;
      if (det < 1e-6) continue;
      const double p = (at.x * b.y - at.y * b.x) / det, q = (a.x * at.y - a.y * at.x) / det;
      if (p < 0.0 || q < 0.0) continue;
      least = std::min(least, p * static_cast<double>(cost.costPerMetre(code, a)) +
                                  q * static_cast<double>(cost.costPerMetre(code, b)));
    }
  return least * length_m;
}

// Property: on a plane, whose cost is uniform but depends on the heading, the best drive is between the
// bound and half a percent above it.
TEST(LowerBound, BoundIsTightOnPlanes) {
  std::mt19937 random(11);
  for (int n = 0; n < 12; ++n) {
    const auto gradient = [&] { return (static_cast<int>(random() % 200) - 100) / 1024.0; };
    const costmap::CellCode code({.dz_dx = gradient(), .dz_dy = gradient(), .curve = 2});
    const maps::Raster<costmap::CellCode> cells(
        {.width = 60, .height = 60, .resolution_m = 1.0, .south_west = {}}, code);
    const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
    const auto place = [&] {
      return maps::Point{static_cast<double>(random() % 600) / 10.0,
                         static_cast<double>(random() % 600) / 10.0};
    };
    const Segment ends{place(), place()};
    if (distance_m(ends.from, ends.to) < 20.0) continue;
    const double cost_J = leastOnPlane_J(map->cost(), code, ends);
    const double bound_J = LowerBound()(map, ends, 0.0);
    EXPECT_LE(bound_J, cost_J) << n;
    EXPECT_GE(bound_J, cost_J / 1.005) << n;
  }
}

// Property: pruning by the cost of a known route changes the bound only through the order of the caps (by
// 0.033 at most on this ground of uncorrelated cells), and a search that ends anywhere proves no more than the
// cost of a route.
TEST(SubSolution, PrunedOrEndedSearchProvesNoMoreThanARouteCosts) {
  int found = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto map = randomGround(seed, testing::driveCost());
    const Segment ends{{-3.3, 5.1}, {30.7, 25.2}};
    const SubSolution::Parts all = partsOf(map, ends);
    const double whole_J = provenBy(Solved(all).u, all).bound_J;
    const SubSolution::Parts near = partsOf(map, ends, 1.05 * whole_J);
    EXPECT_NEAR(provenBy(Solved(near).u, near).bound_J, whole_J, 0.04 * whole_J) << seed;
    const MotionCost cost(map);
    const double along_J = cost.ofLegs(pointRoute(cost, ends, 0.0, std::numeric_limits<double>::infinity()));
    for (const std::size_t quota : {std::size_t{50}, std::size_t{300}, std::size_t{1500}, ~std::size_t{0}})
      EXPECT_LE(provenBy(Solved(all, quota).u, all).bound_J, along_J) << seed << " " << quota;
    found += std::isfinite(along_J) ? 1 : 0;
  }
  EXPECT_GT(found, 2);
}

}  // namespace sub_solution_test
}  // namespace talus::planner
