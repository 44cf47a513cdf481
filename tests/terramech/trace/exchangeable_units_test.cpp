#include <cmath>

#include "noise_table.hpp"

namespace talus::terramech {
namespace {

TEST(ExchangeableUnits, RowsOfIndependentNoiseAreOnTheirOwn) {
  EXPECT_TRUE(NoiseTable(200, 10, 1).units().unit.empty());
  EXPECT_TRUE(NoiseTable(200, 0, 2).units().unit.empty());
}

TEST(ExchangeableUnits, OffsetsOfAFewRunsInTimeAreSeenAsRuns) {
  // Property: a smooth in time could follow five steps as well.
  const ExchangeableUnits units = NoiseTable(150, 5, 3).addOffsets(2.0).units();
  EXPECT_TRUE(units.runs);
  EXPECT_EQ(units.count(), 5);
}

TEST(ExchangeableUnits, AParabolaInTimeIsNotTakenForOffsets) {
  NoiseTable table(240, 24, 4);
  for (int row = 0; row < 240; ++row) table.residual(row, 0) += 3.0 * std::pow(row / 240.0, 2);
  EXPECT_TRUE(table.units().unit.empty());
}

TEST(ExchangeableUnits, NoiseThatLastsIsCutIntoStretchesOfTime) {
  NoiseTable table(300, 0, 5);
  for (int row = 1; row < 300; ++row)
    table.residual(row, 0) = 0.8 * table.residual(row - 1, 0) + 0.6 * table.residual(row, 0);
  const ExchangeableUnits units = table.units();
  EXPECT_FALSE(units.runs);
  EXPECT_GT(units.count(), 5);
  EXPECT_LT(units.count(), 100);
}

TEST(ExchangeableUnits, MeansAreWeightedAndGapsAreNought) {
  // Closed form: (1/1 * 2 + 1/4 * 7) / (1 + 1/4) = 3.
  Eigen::MatrixXd residual(3, 2), std(3, 2);
  residual << 2.0, std::nan(""), 7.0, 5.0, 9.0, std::nan("");
  std << 1.0, 1.0, 2.0, 1.0, 1.0, 1.0;
  const Eigen::MatrixXd mean = unitMeans(residual, std, {0, 0, 1});
  EXPECT_NEAR(mean(0, 0), 3.0, 1e-14);
  EXPECT_NEAR(mean(1, 0), 3.0, 1e-14);
  EXPECT_EQ(mean(2, 0), 9.0);
  EXPECT_EQ(mean(0, 1), 0.0);
  EXPECT_EQ(mean(1, 1), 5.0);
  EXPECT_EQ(mean(2, 1), 0.0);
}

}  // namespace
}  // namespace talus::terramech
