#include <cmath>

#include <talus/terramech/calibration/noise/spline_basis.hpp>

namespace talus::terramech {
namespace spline_basis_test {

using testing::ElementsAre;

TEST(SplineBasis, ColumnsAreOneAtTheirKnotAndSumToOne) {
  const std::vector<double> knots{0.0, 1.0, 2.5, 4.0};
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(knots.data(), 4);
  EXPECT_LT((splineBasis(at, knots) - Eigen::MatrixXd::Identity(4, 4)).norm(), 1e-12);
  const Eigen::VectorXd between = Eigen::VectorXd::LinSpaced(41, -1.0, 5.0);
  EXPECT_LT((splineBasis(between, knots).rowwise().sum() - Eigen::VectorXd::Ones(41)).norm(), 1e-12);
}

TEST(SplineBasis, ReproducesStraightLines) {
  // Closed form: the natural spline through points of a line is the line.
  const std::vector<double> knots{0.0, 1.0, 2.5, 4.0};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(33, 0.0, 4.0);
  const Eigen::Vector4d values(3.0, 1.0, -2.0, -5.0);  // 3 - 2 x at the knots
  EXPECT_LT((splineBasis(x, knots) * values - (3.0 - 2.0 * x.array()).matrix()).norm(), 1e-12);
}

TEST(SplineBasis, NanValuesYieldZeroRows) {
  const Eigen::Vector3d x(0.5, std::nan(""), 1.5);
  EXPECT_EQ(splineBasis(x, {0.0, 1.0, 2.0}).row(1).norm(), 0.0);
}

TEST(SplineBasis, KnotsAreDistinctLevelsOrQuantiles) {
  Eigen::VectorXd levels(7);
  levels << 3.0, 1.0, std::nan(""), 2.0, 1.0, 3.0, 2.0;
  EXPECT_THAT(quantileKnots(levels, 5), ElementsAre(1.0, 2.0, 3.0));
  const auto knots = quantileKnots(Eigen::VectorXd::LinSpaced(101, 0.0, 100.0), 5);
  EXPECT_THAT(knots, ElementsAre(0.0, 25.0, 50.0, 75.0, 100.0));
  EXPECT_TRUE(quantileKnots(Eigen::VectorXd::Constant(3, std::nan("")), 5).empty());
  // Property: knots ascend, with distances of at least a fiftieth of the range.
  Eigen::VectorXd crowded(102);
  crowded << Eigen::VectorXd::LinSpaced(100, 0.0, 0.5), 50.0, 100.0;
  const auto apart = quantileKnots(crowded, 6);
  for (std::size_t k = 1; k < apart.size(); ++k) EXPECT_GT(apart[k] - apart[k - 1], 2.0);
}

TEST(SplineBasis, OrthonormalColumnsSpanTheSameSpace) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Random(12, 4);
  columns.col(3) = 2.0 * columns.col(0) - columns.col(1);  // makes the rank three
  const Eigen::MatrixXd q = orthonormal(columns);
  ASSERT_EQ(q.cols(), 3);
  EXPECT_LT((q.transpose() * q - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((columns - q * (q.transpose() * columns)).norm(), 1e-12);
  EXPECT_EQ(orthonormal(Eigen::MatrixXd(5, 0)).cols(), 0);
}

}  // namespace spline_basis_test
}  // namespace talus::terramech
