#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <talus/terramech/calibration/table/moment_slip.hpp>

namespace talus::terramech {
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
