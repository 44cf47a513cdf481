#include <cmath>

#include <talus/terramech/calibration/noise/nominal_load.hpp>

#include "calibration/slip_rows.hpp"

namespace talus::terramech {
namespace nominal_load_test {

/// Twenty runs of ten rows, each run at another load, with a load-reading error of 3 %. Sinkage over radius
/// follows the true load, with an independent error; `error_share` is the share of reading error in the
/// deviations.
struct Campaign {
  Trial trial = trialOf(std::vector<double>(200, 0.3));
  Eigen::MatrixXd residual = Eigen::MatrixXd::Constant(200, kChannels, std::nan(""));
  InputSlopes slopes{Eigen::MatrixXd::Zero(200, kChannels), Eigen::MatrixXd::Zero(200, kChannels)};
  std::vector<double> deviation = scattered(0.0, 0.03, 200);

  explicit Campaign(double error_share, double first_N = 40.0, double step_N = 3.0) {
    constexpr int kSink = static_cast<int>(Channel::Sinkage);
    const std::vector<double> own = scattered(0.0, 1.0, 399);
    for (int row = 0; row < 200; ++row) {
      const auto r = static_cast<std::size_t>(row);
      trial.run.push_back(row / 10);
      trial.load_N[r] = (first_N + step_N * (row / 10)) * std::exp(deviation[r]);
      slopes.by_load(row, kSink) = 0.1;
      // Each run also has an offset of sinkage: differences between runs are not evidence of the share.
      residual(row, kSink) = 0.02 * (row / 10) - error_share * 0.1 * deviation[r] + 0.001 * own[199 + r];
    }
  }

  std::optional<NominalLoad> found() const { return nominalLoad(trial, residual, slopes); }
};

TEST(NominalLoad, LoadReadingsUnrelatedToContactAreReplacedByRunMeans) {
  const auto set = Campaign(1.0).found();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->error_share, 1.0);
  // Property: the result is the scatter of 200 errors of 0.03 about 20 means. Tolerance: three standard
  // errors.
  EXPECT_NEAR(set->errorStd(), 0.03, 3.0 * 0.03 / std::sqrt(360.0));
  for (int row = 0; row < 200; ++row) EXPECT_NEAR(set->load_N(row, 40.0), std::exp(set->log_mean[row]), 1e-9);
}

TEST(NominalLoad, PartialLoadErrorShareIsEstimatedAndRemoved) {
  const Campaign half(0.5);
  const auto set = half.found();
  ASSERT_TRUE(set);
  // Closed form: the standard error of the share is 0.001 / (0.1 * 0.03 * sqrt(180)) = 0.025. Tolerance:
  // three standard errors.
  EXPECT_NEAR(set->error_share, 0.5, 0.075);
  EXPECT_NEAR(std::log(set->load_N(7, half.trial.load_N[7])) - set->log_mean[7],
              (1.0 - set->error_share) * (std::log(half.trial.load_N[7]) - set->log_mean[7]), 1e-12);
}

TEST(NominalLoad, ExactLoadReadingsAreKept) {
  EXPECT_FALSE(Campaign(0.0).found());
}

TEST(NominalLoad, LoadLevelsMixedWithinRunsAreCalibrated) {
  Campaign mixed(1.0, 40.0, 0.0);
  for (int row = 0; row < 200; ++row) {
    mixed.trial.run[static_cast<std::size_t>(row)] = row;
    if (row % 2 == 0) mixed.trial.load_N[static_cast<std::size_t>(row)] *= 2.0;
    mixed.residual(row, 1) -= 0.02 * (row / 10);
  }
  const auto set = mixed.found();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->rows[0], 100.0);
  EXPECT_NEAR(set->log_mean[0] - set->log_mean[1], std::log(2.0), 0.02);
}

TEST(NominalLoad, ContinuousLoadsAndDrivesHaveNoNominalLoad) {
  Campaign over(1.0);
  for (int row = 0; row < 200; ++row) {
    over.trial.run[static_cast<std::size_t>(row)] = row;
    over.trial.load_N[static_cast<std::size_t>(row)] = 20.0 * std::pow(1.02, row);
  }
  EXPECT_FALSE(over.found());
  Campaign drive(1.0);
  drive.trial.moment.assign(200, 0);
  EXPECT_FALSE(drive.found());
}

}  // namespace nominal_load_test
}  // namespace talus::terramech
