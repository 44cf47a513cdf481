#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/costmap/cost/learned_cells.hpp>

namespace talus::costmap {

namespace learned_cells_test {

CostGrid oneGround(double doubt = 1.0) {
  const auto model = testGround();
  const maps::Grid grid{.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}};
  GroundBelief belief = model->prior(0);
  belief.pull.std *= doubt;
  return flattened(
      maps::Raster<CellCode>(grid, CellCode({.curve = 0})),
      std::make_shared<TravelCost>(model->limits(), std::vector<GroundCost>{model->ground(0, belief)}));
}

TEST(CostWeights, CostIsTheWeightedSumOfEnergyTimeAndRisk) {
  const CostGrid map = oneGround(0.0);  // without failed attempts, which the cost includes
  const auto other = reweighted(map, {.energy = 2.0, .time_W = 3.0, .risk_J = 5e6});
  for (const double gradient : {-0.1, 0.0, 0.05}) {
    const CellCode cell({gradient, 0.0, 0});
    const TravelState state = map.cost().detail(cell, {1.0, 0.0});
    ASSERT_EQ(state.refusal, Refusal::None);
    const double expected = 2.0 * static_cast<double>(state.energy_J_per_m) +
                            3.0 * static_cast<double>(state.time_s_per_m) +
                            5e6 * static_cast<double>(state.risk_per_m);
    // Closed form. Tolerance: the table stores floats.
    EXPECT_NEAR(other->cost().costPerMetre(cell, {1.0, 0.0}), expected, 1e-6 * expected);
  }
}

TEST(CostWeights, ReweightingKeepsInfeasibilityAndSharesTiles) {
  const CostGrid map = oneGround();
  const auto other = reweighted(map, {.energy = 0.0, .time_W = 0.0, .risk_J = 0.0});
  for (double gradient = -0.9; gradient < 0.9; gradient += 0.01) {
    const CellCode cell({gradient, 0.0, 0});
    EXPECT_EQ(std::isinf(other->cost().costPerMetre(cell, {1.0, 0.0})),
              std::isinf(map.cost().costPerMetre(cell, {1.0, 0.0})));
  }
  EXPECT_EQ(other->content().tiles[0], map.content().tiles[0]);
}

TEST(CostWeights, NegativeWeightsAndMapsWithoutStatesAreRejected) {
  EXPECT_REFUSED(reweighted(oneGround(), {.energy = -1.0}), std::invalid_argument,
                 "energy, time_W and risk_J must be >= 0");
  EXPECT_REFUSED(reweighted(oneGround(), {.risk_J = std::nan("")}), std::invalid_argument,
                 "energy, time_W and risk_J must be >= 0");
  const maps::Grid grid{.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}};
  const CostGrid bare =
      flattened(maps::Raster<CellCode>(grid),
                std::make_shared<TravelCost>(TravelCost::Limits{}, std::vector<TravelCurve>(1)));
  EXPECT_REFUSED(reweighted(bare, {}), std::domain_error, "holds no energy, time and risk to weigh");
}

TEST(LearnedCells, CellsAreStoredAndChangesReported) {
  LearnedCells cells({.width = 200, .height = 100, .resolution_m = 1.0, .south_west = {}});
  EXPECT_EQ((cells[{199, 99}]), 0U);
  EXPECT_FALSE(cells.set({70, 5}, 0)) << "it was that before";
  EXPECT_TRUE(cells.boxes().empty());
  EXPECT_TRUE(cells.set({70, 5}, 7));
  EXPECT_FALSE(cells.set({70, 5}, 7));
  EXPECT_TRUE(cells.set({75, 9}, 8));
  EXPECT_EQ((cells[{70, 5}]), 7U);
  EXPECT_EQ((cells[{71, 5}]), 0U);
  ASSERT_EQ(cells.boxes().size(), 1U);
  EXPECT_EQ(cells.boxes()[0].first, (maps::Cell{70, 5}));
  EXPECT_EQ(cells.boxes()[0].last, (maps::Cell{75, 9}));
}

}  // namespace learned_cells_test

}  // namespace talus::costmap
