#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/noise/run_units.hpp>

namespace talus::terramech {
namespace run_units_test {

struct Rows {
  Trial trial;
  Whitening white;
  Eigen::MatrixXd residual;

  Rows(int rows, int runs, std::uint64_t seed) : random(seed) {
    residual = Eigen::MatrixXd::Constant(rows, kChannels, std::nan(""));
    for (int row = 0; row < rows; ++row) {
      trial.states.push_back({.load_N = 50.0, .slip = 0.3, .time_s = 10.0 * row});
      trial.run.push_back(runs > 0 ? row * runs / rows : row);
      residual(row, 0) = normal(random);
    }
    white.std = Eigen::MatrixXd::Ones(rows, kChannels);
    white.factor.assign(static_cast<std::size_t>(rows),
                        Eigen::Matrix4d(Eigen::Vector4d(1, 0, 0, 0).asDiagonal()));
  }

  std::vector<int> units() const { return runUnits(trial, white, residual); }

  void last(double correlation) {
    for (Eigen::Index row = 1; row < residual.rows(); ++row)
      residual(row, 0) =
          correlation * residual(row - 1, 0) + std::sqrt(1.0 - correlation * correlation) * residual(row, 0);
  }

  std::mt19937_64 random;
  std::normal_distribution<double> normal;
};

int countOf(const std::vector<int>& unit) {
  return unit.empty() ? 0 : *std::max_element(unit.begin(), unit.end()) + 1;
}

TEST(RunUnits, EqualTheGivenRuns) {
  EXPECT_EQ(countOf(Rows(200, 10, 1).units()), 10);
}

TEST(RunUnits, RowsWithIndependentNoiseAndNoRunsFormNoUnits) {
  EXPECT_TRUE(Rows(200, 0, 2).units().empty());
}

TEST(RunUnits, AutocorrelatedNoiseIsSplitIntoTimeSegments) {
  Rows alone(300, 0, 5), in_runs(300, 6, 6);
  alone.last(0.8);
  in_runs.last(0.8);
  EXPECT_GT(countOf(alone.units()), 10);
  EXPECT_LT(countOf(alone.units()), 100);
  EXPECT_GT(countOf(in_runs.units()), 6);
}

TEST(RunUnits, AutocorrelationAlongSlipIsNotTreatedAsNoise) {
  Rows rows(300, 6, 6);
  rows.trial.covariates = {"slip"};
  rows.last(0.8);
  for (int row = 0; row < 300; ++row) rows.trial.states[static_cast<std::size_t>(row)].slip = row % 50 / 60.0;
  EXPECT_EQ(countOf(rows.units()), 6);
  for (WheelState& s : rows.trial.states) s.time_s = std::nan("");
  EXPECT_EQ(countOf(rows.units()), 6);
}

TEST(RunUnits, RowsOfOneMomentShareAUnit) {
  Rows rows(400, 0, 7);
  rows.last(0.95);
  for (int row = 0; row < 400; ++row) {
    rows.trial.moment.push_back(row / 4);
    rows.trial.states[static_cast<std::size_t>(row)].time_s = row / 4;
  }
  rows.trial.run = rows.trial.moment;
  const std::vector<int> unit = rows.units();
  ASSERT_EQ(unit.size(), 400U);
  for (std::size_t row = 1; row < 400; ++row)
    if (row % 4 != 0) {
      EXPECT_EQ(unit[row], unit[row - 1]);
    }
}

TEST(RunUnits, UnitMeansAreInverseVarianceWeightedAndZeroIfEmpty) {
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

}  // namespace run_units_test
}  // namespace talus::terramech
