#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

namespace talus::terramech {

/// One channel, unit noise, runs of equal length, one known constant; columns that vary by row or by run.
struct SyntheticTable {
  NullModel null;

  SyntheticTable(int runs, int rows, double run_std, std::uint64_t seed) : random_(seed) {
    const auto count = static_cast<std::size_t>(runs * rows);
    null.factor.assign(count, SharedFactor::Zero());
    for (SharedFactor& f : null.factor) f(0, 0) = 1.0;
    null.residual = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count) * kChannels);
    null.folds = {"whole runs", {}, 5};
    double offset = 0.0;
    for (std::size_t row = 0; row < count; ++row) {
      if (row % static_cast<std::size_t>(rows) == 0) offset = run_std * normal_(random_);
      null.unit.push_back(static_cast<int>(row) / rows);
      null.folds.of_row.push_back(null.unit.back() % 5);
      null.residual[static_cast<Eigen::Index>(row) * kChannels] = normal_(random_) + offset;
    }
    null.known = added(std::vector<double>(count, 1.0)).added;
    null.run_start = RunError::Identity();
  }

  std::vector<double> byRow() {
    std::vector<double> x;
    for (std::size_t row = 0; row < null.factor.size(); ++row) x.push_back(normal_(random_));
    return x;
  }

  std::vector<double> byRun() {
    std::vector<double> of_run, x;
    for (int unit : null.unit) {
      while (static_cast<int>(of_run.size()) <= unit) of_run.push_back(normal_(random_));
      x.push_back(of_run[static_cast<std::size_t>(unit)]);
    }
    return x;
  }

  void hide(const std::vector<double>& column, double size) {
    for (std::size_t row = 0; row < column.size(); ++row)
      null.residual[static_cast<Eigen::Index>(row) * kChannels] += size * column[row];
  }

  static Contender added(const std::vector<double>& column) {
    Contender c;
    c.added.columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(column.size()) * kChannels, 1);
    for (std::size_t row = 0; row < column.size(); ++row)
      c.added.columns(static_cast<Eigen::Index>(row) * kChannels, 0) = column[row];
    c.added.prior = {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 1e-4)};
    return c;
  }

  GainDistribution contest(const std::vector<std::vector<double>>& columns, std::uint64_t seed = 1) const {
    return gainDistribution(null, {columns.size(), [&](std::size_t k) { return added(columns[k]); }}, 99,
                            seed, [](double) { return true; });
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace talus::terramech
