#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/terramech/trace/whitening.hpp>

namespace talus::terramech {
namespace {

constexpr int kUnits = 40, kRows = 6;

std::vector<int> units() {
  std::vector<int> unit;
  for (int row = 0; row < kUnits * kRows; ++row) unit.push_back(row / kRows);
  return unit;
}

/// Rows of unit noise in one channel, each unit with an offset of its own.
Eigen::MatrixXd residual(double offset_std, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd r = Eigen::MatrixXd::Constant(kUnits * kRows, kChannels, std::nan(""));
  for (int u = 0; u < kUnits; ++u) {
    const double offset = offset_std * normal(random);
    for (int k = 0; k < kRows; ++k) r(u * kRows + k, 0) = offset + normal(random);
  }
  return r;
}

Whitening plain() {
  Whitening w;
  w.factor.assign(kUnits * kRows, Eigen::Matrix4d(Eigen::Vector4d(1, 0, 0, 0).asDiagonal()));
  w.std = Eigen::MatrixXd::Ones(kUnits * kRows, kChannels);
  return w;
}

TEST(Whitening, AMeanThatRowsShareWeighsWhatItIsWorth) {
  // Closed form: with variance q shared and 1 of its own, the mean of m rows has variance q + 1/m, so that a
  // constant of 1 is worth units / (q + 1/m) in chi-squared.
  Whitening w = plain();
  w.share(units(), residual(2.0, 1));
  const double q = w.shared_white[0];
  EXPECT_NEAR(q, 4.0, 2.0);  // 40 units know a variance to 22 %
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(kUnits * kRows, kChannels);
  EXPECT_NEAR(w.apply(one).squaredNorm(), kUnits / (q + 1.0 / kRows), 1e-9);
  EXPECT_NEAR(w.marginal(one).squaredNorm(), kUnits / (w.shared_marginal[0] + 1.0 / kRows), 1e-9);
}

TEST(Whitening, RowsThatShareNothingAreLeftAlone) {
  Whitening w = plain();
  w.share({}, residual(0.0, 2));
  const Eigen::MatrixXd r = residual(0.0, 3);
  double sum = 0.0;
  for (double v : r.col(0)) sum += v * v;
  EXPECT_NEAR(w.apply(r).squaredNorm(), sum, 1e-9);
}

TEST(Whitening, ColumnsComeBackToWhatTheyGave) {
  // Property: <columns, W r> = <W^T columns, r> for any residual.
  Whitening w = plain();
  for (std::size_t row = 0; row < w.factor.size(); ++row) {
    w.factor[row] << 2, 0, 0, 0, -0.5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
    w.std(static_cast<Eigen::Index>(row), 0) = 0.5;
  }
  Eigen::MatrixXd left = residual(1.5, 4);
  left.col(1) = residual(1.0, 5).col(0);
  w.share(units(), left);
  ASSERT_GT(w.shared_white[1], 0.0);
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(left.rows() * kChannels, 2);
  Eigen::VectorXd stacked(left.rows() * kChannels);
  for (Eigen::Index row = 0; row < left.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      stacked[row * kChannels + c] = std::isfinite(left(row, c)) ? left(row, c) : 0.0;
  EXPECT_LT((columns.transpose() * w.apply(left) - w.backFromApply(columns).transpose() * stacked).norm(),
            1e-9);
  EXPECT_LT(
      (columns.transpose() * w.marginal(left) - w.backFromMarginal(columns).transpose() * stacked).norm(),
      1e-9);
}

}  // namespace
}  // namespace talus::terramech
