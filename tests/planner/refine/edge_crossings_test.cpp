#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/refine/edge_crossings.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace edge_crossings_test {

using costmap::CellCode;

std::vector<CellCode> randomCells() {
  std::mt19937 random(8);
  std::vector<CellCode> cells;
  const auto gradient = [&random] { return (static_cast<int>(random() % 700) - 350) / 1024.0; };
  for (int k = 0; k < 400; ++k)
    cells.push_back(CellCode(
        {.dz_dx = gradient(), .dz_dy = gradient(), .curve = static_cast<std::uint8_t>(random() % 5)}));
  return cells;
}

// Property: the cost of each motion is TravelCost in its heading times its length, to float rounding; each
// point of the other sides occurs once.
TEST(EdgeCrossings, CostIsDriveCostTimesLength) {
  const auto cost = testing::driveCost({.max_along = 0.3, .max_across = 0.25});
  for (const int points : {1, 2, 3, 5}) {
    const EdgeCrossings crossings(*cost, points), scalar(*cost, points, Kernels::Scalar);
    std::vector<float> paid(static_cast<std::size_t>(crossings.count() + EdgeCrossings::kVector)),
        same = paid;
    for (const CellCode cell : randomCells())
      for (int side = 0; side < 4; ++side)
        for (int k = 0; k < points; ++k) {
          crossings.prices(side, k, cell, 7.0F, paid.data());
          scalar.prices(side, k, cell, 7.0F, same.data());
          const EdgeSpot a = edgeSpot(side, k, points);
          int met = 0;
          for (int i = 0; i < crossings.count(); ++i) {
            const EdgeCrossings::End end = crossings.ends(side, k)[i];
            ASSERT_NE(end.side, side);
            met |= 1 << (end.side * points + end.k);
            const EdgeSpot b = edgeSpot(end.side, end.k, points);
            const double length = std::hypot(b.x - a.x, b.y - a.y);
            const auto metre_J =
                static_cast<double>(cost->costPerMetre(cell, {(b.x - a.x) / length, (b.y - a.y) / length}));
            const auto price = static_cast<double>(paid[static_cast<std::size_t>(i)]);
            ASSERT_EQ(paid[static_cast<std::size_t>(i)], same[static_cast<std::size_t>(i)]);
            ASSERT_EQ(crossings.allowed(side, k, i, cell), std::isfinite(metre_J));
            ASSERT_EQ(std::isfinite(price), std::isfinite(metre_J));
            if (std::isfinite(metre_J)) {
              ASSERT_NEAR(price, 7.0 + metre_J * length, 1e-5 * price);
            }
          }
          EXPECT_EQ(std::popcount(static_cast<unsigned>(met)), crossings.count());
        }
  }
}

// Property: a cell marked free allows every heading; most cells that allow every heading are marked free.
TEST(EdgeCrossings, FreeCellsAllowEveryHeading) {
  const auto cost = testing::driveCost({.max_along = 0.3, .max_across = 0.25});
  const EdgeCrossings crossings(*cost, 2);
  int free = 0, all = 0;
  for (const CellCode cell : randomCells()) {
    bool every = true;
    for (int d = 0; d < 720; ++d)
      every = every && std::isfinite(cost->costPerMetre(cell, {std::cos(d * std::numbers::pi / 360),
                                                               std::sin(d * std::numbers::pi / 360)}));
    if (crossings.free(cell)) {
      EXPECT_TRUE(every);
    }
    free += crossings.free(cell);
    all += every;
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(free, 0.9 * all);
  EXPECT_FALSE(crossings.free(CellCode({.curve = CellCode::kBlocked})));
  EXPECT_FALSE(crossings.free(CellCode({.curve = CellCode::kUnknown})));
}

}  // namespace edge_crossings_test
}  // namespace talus::planner
