#include <cmath>
#include <random>
#include <set>
#include <stop_token>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace edge_layer_test {

// Closed form: the minimum is 10 J/m on level ground (10 + 400 g^2 downhill). The maximum is that of the
// fifth curve: five times the cost of the steepest climb in the table, 76/256, in row 12, the last cross
// slope allowed.
TEST(CostRange, RangeCoversAllAllowedMetres) {
  const CostRange range = costRange(*testing::driveCost());
  const double g = 76.0 / 256;
  EXPECT_NEAR(range.least_J_per_m, 10.0, 1e-6);
  EXPECT_NEAR(range.most_J_per_m, 5 * (10 + 100 * g + 400 * g * g) * (1.0 + 0.08 * 12), 1e-3);
  EXPECT_TRUE(
      std::isinf(costRange(costmap::TravelCost({}, std::vector<costmap::TravelCurve>{})).least_J_per_m));
}

std::vector<costmap::CellCode> randomCells(unsigned count) {
  std::mt19937 random(5);
  std::vector<costmap::CellCode> cells;
  const auto gradient = [&random] { return (static_cast<int>(random() % 900) - 450) / 1024.0; };
  for (unsigned k = 0; k < count; ++k) {
    const auto curve = static_cast<std::uint8_t>(k % 11 == 0 ? 254U + k % 2U : random() % 5U);
    cells.push_back(costmap::CellCode({.dz_dx = gradient(), .dz_dy = gradient(), .curve = curve}));
  }
  return cells;
}

// Property: a half edge costs half the cell's side (or diagonal) at TravelCost's value, and is blocked where
// TravelCost refuses; also for other resolutions, limits and units. Tolerance: nodes and sum are each
// rounded to a unit, shares to 1/128, and neighbouring nodes differ by less than half.
TEST(EdgeUnits, HalfEdgesMatchDriveCost) {
  int allowed = 0;
  for (const double limit : {0.2, 0.29, 0.4})
    for (const double coarsening : {1.0, 3.0}) {
      const auto cost = testing::driveCost({.max_along = 0.3, .max_across = limit});
      const EdgeUnits units(*cost, 2.5, coarsening);
      for (const costmap::CellCode cell : randomCells(3'000)) {
        const EdgeUnits::Halves halves = units.halves(cell);
        for (std::size_t k = 0; k < 8; ++k) {
          const maps::Cell step = kStep[k];
          const double length = std::hypot(step.column, step.row);
          const auto metre_J =
              static_cast<double>(cost->costPerMetre(cell, {step.column / length, step.row / length}));
          ASSERT_EQ(halves[k] != EdgeUnits::kBlocked, std::isfinite(metre_J)) << k;
          if (std::isinf(metre_J)) continue;
          ++allowed;
          const double want = 0.5 * 2.5 * length * metre_J / units.unit_J();
          ASSERT_NEAR(halves[k], want, 1.0 + 0.5 * want / 256.0);
          ASSERT_GE(2 * halves[k] + 1, static_cast<int>(units.cheapestEdge()));
        }
      }
    }
  EXPECT_GT(allowed, 20'000);
}

TEST(EdgeUnits, VectorAndScalarKernelsAreIdentical) {
  if (!vectorsRun(Kernels::Best)) GTEST_SKIP() << "no AVX2 on this machine";
  const EdgeUnits units(*testing::driveCost(), 1.0);
  const auto cells = randomCells(5'000);
  std::vector<EdgeUnits::Halves> scalar(cells.size()), vector(cells.size());
  units.halves(cells.data(), cells.size(), scalar.data(), false);
  units.halves(cells.data(), cells.size(), vector.data(), true);
  EXPECT_EQ(scalar, vector);
}

TEST(EdgeUnits, ExtendsDetectsAppendedCurves) {
  const auto curves = testing::driveCost()->curves();
  const auto of = [](std::vector<costmap::TravelCurve> some) {
    return EdgeUnits(costmap::TravelCost({}, std::move(some)), 1.0);
  };
  // The cheapest and the most expensive curve stay first, because they determine the unit.
  const std::vector<costmap::TravelCurve> two{curves[0], curves[4]}, three{curves[0], curves[4], curves[2]},
      swapped{curves[4], curves[0]};
  EXPECT_TRUE(of(three).extends(of(two)));
  EXPECT_FALSE(of(two).extends(of(three)));
  EXPECT_FALSE(of(swapped).extends(of(two)));
  EXPECT_FALSE(EdgeUnits(costmap::TravelCost({}, two), 2.0).extends(of(two)));
}

using testing::randomMap;

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

std::shared_ptr<const EdgeLayer> edgesOf(const MapPointer& map, int threads = 1) {
  return std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), map->grid().resolution_m), threads);
}

// Property: an edge equals MotionCost between the centres, to one unit and 1/256 of the difference between
// neighbouring nodes (less than half a half-edge). The grid allows no motion that the exact segment does
// not.
TEST(EdgeLayer, EdgeCostMatchesTheMotionBetweenCentres) {
  int allowed = 0, blocked = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto map = randomMap({.width = 21, .height = 18, .seed = seed, .blocked = 0.2, .roughness = 0.35});
    const Kernels kernels = seed % 2 == 0 ? Kernels::Best : Kernels::Scalar;
    const auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0), 1, StopCheck{}, kernels);
    const MotionCost cost(map);
    for (int row = 0; row < 18; ++row)
      for (int column = 0; column < 21; ++column)
        for (std::size_t k = 0; k < 8; ++k) {
          const maps::Cell to{column, row}, from{column + kStep[k].column, row + kStep[k].row};
          const std::uint16_t edge = edges->into(edges->padded().index(to))[k];
          const double exact_J = cost({map->grid().centre(from), map->grid().centre(to)});
          ASSERT_EQ(edge != EdgeLayer::kBlocked, std::isfinite(exact_J)) << seed;
          ++(edge == EdgeLayer::kBlocked ? blocked : allowed);
          if (edge == EdgeLayer::kBlocked) continue;
          ASSERT_NEAR(edge * edges->units().unit_J(), exact_J,
                      2.0 * edges->units().unit_J() + 0.5 / 256.0 * exact_J);
        }
  }
  EXPECT_GT(allowed, 5'000);
  EXPECT_GT(blocked, 5'000);
}

// Property: after an update for a patch, across tile edges and at the map's border, the layer equals a
// rebuilt one.
TEST(EdgeLayer, UpdateEqualsRebuild) {
  const auto map = randomMap({.width = 100, .height = 90, .seed = 7});
  for (const CellBox box : {CellBox{{60, 60}, {70, 68}}, {{0, 0}, {3, 89}}, {{99, 89}, {99, 89}}}) {
    const costmap::Revision revision{
        .ranges = {{box.first, box.last}},
        .code = [](maps::Cell c, costmap::CellCode code) { return code.withCurve(c.row % 2 ? 255 : 3); },
        .cost = [&] { return map->content().cost; }};
    const auto newer = std::make_shared<costmap::CostGrid>(costmap::revised(*map, revision));
    EdgeLayer updated(map, EdgeUnits(map->cost(), 1.0));
    updated.update(newer, updated.units(), box);
    const auto anew = edgesOf(newer);
    for (std::size_t i = 0; i < anew->padded().size(); ++i)
      for (int k = 0; k < 8; ++k) ASSERT_EQ(updated.into(i)[k], anew->into(i)[k]) << i;
  }
}

TEST(EdgeLayer, StoppedLayerIsIncomplete) {
  const auto map = randomMap({.width = 90, .height = 90});
  std::stop_source source;
  source.request_stop();
  const EdgeUnits units(map->cost(), 1.0);
  EXPECT_FALSE(
      EdgeLayer(map, units, 1, ProgressMonitor{.progress = {}, .stop = source.get_token()}).complete());
  EXPECT_TRUE(EdgeLayer(map, units).complete());
}

TEST(EdgeLayer, ResultIsIndependentOfThreadCount) {
  const auto map = randomMap({.width = 90, .height = 300, .seed = 2});
  const auto one = edgesOf(map, 1), three = edgesOf(map, 3);
  for (std::size_t i = 0; i < one->padded().size(); ++i)
    for (int k = 0; k < 8; ++k) ASSERT_EQ(one->into(i)[k], three->into(i)[k]);
}

using testing::drawn;

// Property: successive cells of a descent are neighbours, and the sum of their edges, with the cost at the
// goal, equals the field to the unit.
TEST(Descent, DescentCostEqualsTheField) {
  int walked = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto edges = edgesOf(randomMap({.seed = seed, .blocked = 0.2, .roughness = 0.3}));
    CostToGo field(edges, {{.cell = {3, 4}, .cost_J = 20.0}, {.cell = {16, 12}}});
    ASSERT_TRUE(field.settleAll());
    for (int row = 0; row < 20; ++row)
      for (int column = 0; column < 20; ++column) {
        const auto path = field.path({column, row});
        if (path.empty()) {
          EXPECT_EQ(field.units({column, row}), CostToGo::kUnreached);
          continue;
        }
        ++walked;
        std::uint32_t sum = field.atGoal(edges->padded().index(path.back()));
        for (std::size_t i = 1; i < path.size(); ++i) {
          const maps::Cell back{path[i - 1].column - path[i].column, path[i - 1].row - path[i].row};
          const auto heading = std::ranges::find(kStep, back) - kStep.begin();
          ASSERT_LT(heading, 8);
          sum += edges->into(edges->padded().index(path[i]))[heading];
        }
        ASSERT_EQ(sum, field.units({column, row})) << seed;
      }
  }
  EXPECT_GT(walked, 1'000);
}

TEST(Descent, UnsettledFieldYieldsNoDescent) {
  CostToGo field(edgesOf(drawn({"....."})), {{.cell = {0, 0}}});
  EXPECT_TRUE(field.path({4, 0}).empty());  // the distance is unknown
}

using costmap::CellCode;

std::shared_ptr<const costmap::CostGrid> with(const costmap::CostGrid& map,
                                              const std::vector<maps::Cell>& cells) {
  costmap::Revision revision{
      .code = [](maps::Cell, CellCode code) { return code.withCurve(CellCode::kBlocked); },
      .cost = [cost = map.content().cost] { return cost; }};
  for (const maps::Cell cell : cells) revision.ranges.push_back({cell, cell});
  return std::make_shared<costmap::CostGrid>(costmap::revised(map, revision));
}

// Property: the result is the smallest box that contains the changed cells, across tiles of 64 cells and at
// the map's border.
TEST(MapChange, ChangeIsTheMinimalBoxOfDifferingCells) {
  const auto map = randomMap({.width = 150, .height = 140, .seed = 4, .blocked = 0.0});
  for (unsigned seed = 1; seed <= 30; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&random](unsigned limit) { return static_cast<int>(random() % limit); };
    std::vector<maps::Cell> cells;
    CellBox box{{150, 140}, {-1, -1}};
    for (int k = below(4); k >= 0; --k) {
      cells.push_back({below(150), below(140)});
      box.first = {std::min(box.first.column, cells.back().column),
                   std::min(box.first.row, cells.back().row)};
      box.last = {std::max(box.last.column, cells.back().column), std::max(box.last.row, cells.back().row)};
    }
    const auto found = changedCells(*map, *with(*map, cells));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->first, box.first) << seed;
    EXPECT_EQ(found->last, box.last) << seed;
  }
}

TEST(MapChange, EqualMapsHaveNoChange) {
  const auto map = randomMap({.width = 70, .height = 70, .blocked = 1.0});
  EXPECT_FALSE(changedCells(*map, *map));
  EXPECT_FALSE(changedCells(*map, *with(*map, {{5, 5}, {68, 2}})));  // rewritten with the same values
}

}  // namespace edge_layer_test

}  // namespace talus::planner
