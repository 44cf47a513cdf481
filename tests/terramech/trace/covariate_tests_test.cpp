#include "noise_table.hpp"
#include "slip_rows.hpp"

namespace talus::terramech {
namespace {

TEST(CovariateTests, OffsetsOfAFewRunsRaiseNoAlarm) {
  // Property: p <= 0.05 in about one of twenty tables of four runs each; five or more of forty has
  // probability 0.05.
  int alarms = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed)
    alarms += NoiseTable(80, 4, seed).addOffsets(2.0).pValue("") <= 0.05;
  EXPECT_LE(alarms, 5);
}

TEST(CovariateTests, WhatVariesWithinRunsIsFoundInFourOfThem) {
  NoiseTable table(80, 4, 6);
  table.addOffsets(2.0);
  for (int row = 0; row < 80; ++row)
    table.residual(row, 0) += 6.0 * (table.trial.slip[static_cast<std::size_t>(row)] - 0.3);
  EXPECT_TRUE(table.units().runs);
  EXPECT_LE(table.pValue("slip"), 0.01);
  EXPECT_GT(table.pValue("time_s"), 0.05);
}

TEST(CovariateTests, AnErrorThatAllRowsShareIsNotAConstant) {
  // Property: an offset of two standard deviations of a shared error is certain without it, and not with it.
  const std::vector<double> wobble = scattered(0.0, 0.01, 120);
  Trial trial = trialOf(std::vector<double>(120, 0.3));
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 1; c < kChannels; ++c) trial.measured(row, c) = std::nan("");
  Eigen::MatrixXd residual = trial.measured;
  for (int row = 0; row < trial.rows(); ++row)
    residual(row, 0) = 0.02 + wobble[static_cast<std::size_t>(row)];
  SensorNoise noise;
  noise.absolute[0] = 0.5;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  const Whitening white = whitening(trial, none, {none, none}, noise);
  TestPlan plan;
  plan.nuisance_whitened = plan.nuisance_marginal = Eigen::MatrixXd(trial.rows() * kChannels, 0);
  plan.flips = 999;
  const auto p = [&] {
    return testCovariates(trial, white, residual, Eigen::VectorXd::Zero(trial.rows()), plan).front().p_value;
  };
  EXPECT_LT(p(), 0.002);
  plan.shared_error = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  plan.shared_error.col(0).setConstant(0.01);
  const double shared = p();
  EXPECT_GT(shared, 0.02);
  EXPECT_LT(shared, 0.09);
}

}  // namespace
}  // namespace talus::terramech
