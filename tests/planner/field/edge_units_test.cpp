#include <cmath>
#include <random>

#include <talus/planner/field/edge_units.hpp>
#include <talus/planner/route/kernels.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace edge_units_test {

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

}  // namespace edge_units_test
}  // namespace talus::planner
