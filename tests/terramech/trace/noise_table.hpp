#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <talus/terramech/trace/covariate_tests.hpp>
#include <talus/terramech/trace/exchangeable_units.hpp>

namespace talus::terramech {

/// Drawbar pull alone, unit noise, slips at random, rows one after another in time; runs of equal length.
struct NoiseTable {
  Trial trial;
  Eigen::MatrixXd residual;
  Whitening white;

  NoiseTable(int rows, int runs, std::uint64_t seed) : random_(seed) {
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

  NoiseTable& addOffsets(double std) {
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

}  // namespace talus::terramech
