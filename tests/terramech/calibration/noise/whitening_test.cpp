#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {
namespace whitening_test {

constexpr int kUnits = 40, kRows = 6;

std::vector<int> units() {
  std::vector<int> unit;
  for (int row = 0; row < kUnits * kRows; ++row) unit.push_back(row / kRows);
  return unit;
}

/// Rows of unit noise in one channel, with a random offset for each unit.
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

TEST(Whitening, SharedErrorLimitsTheWeightOfAMean) {
  // Closed form: with the shared variance q and the independent variance 1, the mean of m rows has variance q
  // + 1/m, so that a constant of 1 has the chi-squared units / (q + 1/m).
  Whitening w = plain();
  w.common.unit = units();
  w.common.run(0, 0) = 4.0;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(kUnits * kRows, kChannels);
  EXPECT_NEAR(w.apply(one).squaredNorm(), kUnits / (4.0 + 1.0 / kRows), 1e-9);
}

TEST(Whitening, ResidualsWithoutSharedErrorAreUnchanged) {
  Whitening w = plain();
  const Eigen::MatrixXd r = residual(0.0, 3);
  double sum = 0.0;
  for (double v : r.col(0)) sum += v * v;
  EXPECT_NEAR(w.apply(r).squaredNorm(), sum, 1e-9);
}

TEST(Whitening, IsTheInverseRootOfTheWholeCovariance) {
  // Independent derivation: r^T V^-1 r with the dense covariance V of the rows.
  Whitening w;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const auto noise = [&] { return RunError(RunError::NullaryExpr([&] { return normal(random); })); };
  constexpr int kCount = 9;
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(4 * kCount, 4 * kCount);
  const RunError root = noise();
  w.common.run = root * root.transpose();
  w.std = Eigen::MatrixXd::Ones(kCount, kChannels);
  for (int row = 0; row < kCount; ++row) {
    Eigen::Matrix4d f = noise().topLeftCorner<4, 4>().triangularView<Eigen::Lower>();
    f.diagonal() = f.diagonal().cwiseAbs().array() + 0.5;
    w.factor.push_back(f);
    w.common.unit.push_back(row / 3);
    w.common.by_soil.emplace_back(noise().topRightCorner<4, kShared - 4>());
    v.block<4, 4>(4 * row, 4 * row) = (f.transpose() * f).inverse();
  }
  const auto loading = [&](int row) {
    SharedFactor f = SharedFactor::Identity();
    f.rightCols<kShared - 4>() = w.common.by_soil[static_cast<std::size_t>(row)];
    return f;
  };
  for (int a = 0; a < kCount; ++a)
    for (int b = 0; b < kCount; ++b)
      if (a / 3 == b / 3) v.block<4, 4>(4 * a, 4 * b) += loading(a) * w.common.run * loading(b).transpose();
  Eigen::MatrixXd r(kCount, kChannels);
  Eigen::VectorXd stacked(4 * kCount);
  for (int row = 0; row < kCount; ++row)
    for (int c = 0; c < kChannels; ++c) stacked[4 * row + c] = r(row, c) = normal(random);
  EXPECT_NEAR(w.apply(r).squaredNorm(), stacked.dot(v.inverse() * stacked), 1e-8);
}

}  // namespace whitening_test
namespace moment_slip_test {

// Seven rows of two channels in three moments; the single row of the third moment does not depend on the
// slip.
MomentSlip someSlip() {
  std::mt19937_64 random{5};
  std::normal_distribution<double> normal;
  MomentSlip slip{{0, 0, 1, 0, 1, 2, 1}, Eigen::MatrixXd(7, 2)};
  for (double& u : slip.moved.reshaped()) u = normal(random);
  slip.moved.row(5).setZero();
  return slip;
}

Eigen::MatrixXd covarianceOf(const MomentSlip& slip) {
  const Eigen::Index n = slip.moved.size(), channels = slip.moved.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (slip.moment[static_cast<std::size_t>(i / channels)] ==
          slip.moment[static_cast<std::size_t>(j / channels)])
        all(i, j) += slip.moved(i / channels, i % channels) * slip.moved(j / channels, j % channels);
  return all;
}

TEST(MomentSlip, WhiteningYieldsIndependentRows) {
  const MomentSlip slip = someSlip();
  const Eigen::Index n = slip.moved.size();
  Eigen::MatrixXd taken(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, k);
    slip.takeOut(unit);
    taken.col(k) = unit;
  }
  // Closed form: the whitening matrix A and the dense covariance V give A V A^T = I.
  EXPECT_LT((taken * covarianceOf(slip) * taken.transpose() - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-12);
}

TEST(MomentSlip, LikelihoodEqualsThatOfTheDenseNormal) {
  const MomentSlip slip = someSlip();
  const Eigen::VectorXd rows = Eigen::VectorXd::LinSpaced(slip.moved.size(), -2.0, 1.5);
  const Eigen::MatrixXd covariance = covarianceOf(slip);
  // Closed form: normal densities by the dense inverse and determinant.
  const double dense =
      -0.5 * rows.dot(covariance.inverse() * rows) - 0.5 * std::log(covariance.determinant());
  EXPECT_NEAR(slip.logLikelihood(rows), dense + 0.5 * rows.squaredNorm(), 1e-10);
}

TEST(MomentSlip, SubsetKeepsMomentsOfItsRows) {
  const MomentSlip slip = someSlip(), part = subset(slip, {1, 0, 1, 1, 0, 0, 1});
  EXPECT_EQ(part.moment, (std::vector<int>{0, 1, 0, 1}));
  EXPECT_EQ(part.moved.row(3), slip.moved.row(6));
  EXPECT_TRUE(subset(MomentSlip{}, {1, 0}).moment.empty());
}

}  // namespace moment_slip_test

}  // namespace talus::terramech
