#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace sub_solution_test {

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

// Input on the whole map, with the lower bounds of level 1 from the start.
SubSolution::Parts partsOf(const MapPointer& map, const Segment& places) {
  FittedOctagons octagons(map->cost());
  const auto octagon_of = [&](maps::Cell cell) { return octagons.of(map->at(cell)); };
  const maps::Cell start = *map->grid().cellAt(places.from);
  std::vector<FieldGoal> corners;
  for (const int row : {start.row, start.row + 1})
    for (const int column : {start.column, start.column + 1}) corners.push_back({{column, row}, 0.0});
  return {.map = map,
          .places = places,
          .most_J = std::numeric_limits<double>::infinity(),
          .cheapest_J = cheapestMetre_J(*map),
          .from_start = cornerField(map, octagon_of, corners, {}, RouteSense::FromStart)};
}

// A sub-solution by a search without a limit of its work.
struct Solved {
  explicit Solved(const SubSolution::Parts& parts)
      : limits(parts.map->cost()), u(parts, limits, ~std::size_t{0}, {}) {}
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

}  // namespace sub_solution_test
}  // namespace talus::planner
