#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/terramech/trace/covariate_tests.hpp>
#include <talus/terramech/trace/exchangeable_units.hpp>

namespace talus::terramech {
namespace {

/// Drawbar pull alone, unit noise, slips at random, rows one after another in time; runs of equal length.
struct Table {
  Trial trial;
  Eigen::MatrixXd residual;
  Whitening white;

  Table(int rows, int runs, std::uint64_t seed) : random_(seed) {
    for (int row = 0; row < rows; ++row) {
      trial.states.push_back({.load_N = 50.0, .slip = uniform_(random_), .time_s = 10.0 * row});
      trial.load_N.push_back(50.0);
      trial.slip.push_back(trial.states.back().slip);
      trial.run.push_back(runs > 0 ? row * runs / rows : row);
    }
    trial.covariates = {"slip", "time_s"};
    trial.measured = Eigen::MatrixXd::Constant(rows, kChannels, std::nan(""));
    trial.slip_variance = trial.load_variance = Eigen::VectorXd::Zero(rows);
    residual = trial.measured;
    for (int row = 0; row < rows; ++row) residual(row, 0) = normal_(random_);
    trial.measured.col(0).setZero();
    white.std = Eigen::MatrixXd::Ones(rows, kChannels);
    white.factor.assign(static_cast<std::size_t>(rows),
                        Eigen::Matrix4d(Eigen::Vector4d(1, 0, 0, 0).asDiagonal()));
  }

  Table& addOffsets(double std) {
    std::vector<double> offset;
    for (int row = 0; row < trial.rows(); ++row) {
      const auto run = static_cast<std::size_t>(trial.run[static_cast<std::size_t>(row)]);
      while (offset.size() <= run) offset.push_back(std * normal_(random_));
      residual(row, 0) += offset[run];
    }
    return *this;
  }

  ExchangeableUnits units() const { return exchangeableUnits(trial, white, residual); }

  double pValue(const std::string& covariate) const {
    TestPlan plan;
    plan.nuisance_whitened = plan.nuisance_marginal = Eigen::MatrixXd(trial.rows() * kChannels, 0);
    plan.units = units();
    plan.flips = 499;
    double p = 1.0;
    for (const auto& t : testCovariates(trial, white, residual, Eigen::VectorXd::Zero(trial.rows()), plan))
      if (covariate.empty() || t.covariate == covariate) p = std::min(p, t.p_value);
    return p;
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0.05, 0.6};
  std::normal_distribution<double> normal_;
};

TEST(ExchangeableUnits, RowsOfIndependentNoiseAreOnTheirOwn) {
  EXPECT_TRUE(Table(200, 10, 1).units().unit.empty());
  EXPECT_TRUE(Table(200, 0, 2).units().unit.empty());
}

TEST(ExchangeableUnits, OffsetsOfAFewRunsInTimeAreSeenAsRuns) {
  // Property: a smooth in time could follow five steps as well.
  const ExchangeableUnits units = Table(150, 5, 3).addOffsets(2.0).units();
  EXPECT_TRUE(units.runs);
  EXPECT_EQ(units.count(), 5);
}

TEST(ExchangeableUnits, AParabolaInTimeIsNotTakenForOffsets) {
  Table table(240, 24, 4);
  for (int row = 0; row < 240; ++row) table.residual(row, 0) += 3.0 * std::pow(row / 240.0, 2);
  EXPECT_TRUE(table.units().unit.empty());
}

TEST(ExchangeableUnits, NoiseThatLastsIsCutIntoStretchesOfTime) {
  Table table(300, 0, 5);
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

TEST(CovariateTests, OffsetsOfAFewRunsRaiseNoAlarm) {
  // Property: p <= 0.05 in about one of twenty tables of four runs each; five or more of forty has
  // probability 0.05.
  int alarms = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed)
    alarms += Table(80, 4, seed).addOffsets(2.0).pValue("") <= 0.05;
  EXPECT_LE(alarms, 5);
}

TEST(CovariateTests, WhatVariesWithinRunsIsFoundInFourOfThem) {
  Table table(80, 4, 6);
  table.addOffsets(2.0);
  for (int row = 0; row < 80; ++row)
    table.residual(row, 0) += 6.0 * (table.trial.slip[static_cast<std::size_t>(row)] - 0.3);
  EXPECT_TRUE(table.units().runs);
  EXPECT_LE(table.pValue("slip"), 0.01);
  EXPECT_GT(table.pValue("time_s"), 0.05);
}

}  // namespace
}  // namespace talus::terramech
