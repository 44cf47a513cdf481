#include <cmath>

#include <talus/terramech/calibration/noise/sensor_noise.hpp>

#include "calibration/slip_rows.hpp"

namespace talus::terramech {

namespace sensor_noise_test {

using testing::ElementsAre;

// Rows at slips from 0.1 to 0.6 with measurements of the pull only.
Trial pullAlone(int rows) {
  std::vector<double> slips;
  for (int k = 0; k < rows; ++k) slips.push_back(0.1 + 0.5 * ((k * 37) % rows) / rows);
  Trial trial = trialOf(slips);
  trial.covariates = {"slip"};
  trial.measured.rightCols(kChannels - 1).setConstant(std::nan(""));
  return trial;
}

// Returns residuals with a normal error of the pull over load.
Eigen::MatrixXd pullError(const Trial& trial, double std) {
  Eigen::MatrixXd residual = trial.measured;
  const std::vector<double> error = scattered(0.0, std, trial.rows());
  for (int row = 0; row < trial.rows(); ++row) residual(row, 0) = error[static_cast<std::size_t>(row)];
  return residual;
}

TEST(SensorNoise, RecoversNoiseStdFromPureNoise) {
  const Trial trial = pullAlone(400);
  const Eigen::MatrixXd level = Eigen::MatrixXd::Constant(400, kChannels, 0.2);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(400, kChannels);
  for (const double std : {0.01, 0.04}) {
    const SensorNoise noise = fitNoise(trial, pullError(trial, std), level, {none, none}, {});
    // Closed form: absolute and relative parts at a pull of 0.2 times 50 N add in squares. Tolerance: 3.5 %
    // is the standard error of a standard deviation from 400 values.
    EXPECT_NEAR(std::hypot(noise.absolute[0] / 50.0, 0.2 * noise.relative[0]), std, 0.12 * std);
  }
}

TEST(SensorNoise, FewRowsKeepStatedNoise) {
  const Trial trial = pullAlone(8);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(8, kChannels);
  const SensorNoise noise =
      fitNoise(trial, pullError(trial, 0.02), none, {none, none}, {.drawbar_pull_N = 1.0});
  // Tolerance: three times the 25 % uncertainty of a stated standard deviation.
  EXPECT_NEAR(std::log(noise.absolute[0] / 1.0), 0.0, 0.75);
}

TEST(SensorNoise, SensorWithNoiseFarAboveItsStatedStdIsListed) {
  // Closed form: errors of 0.6 N, and of 8 % of 0.2 times 50 N, add in squares to 1 N, 1.6 times and 1.7
  // times the stated error; the limit is e^0.5 = 1.65.
  const Trial trial = pullAlone(20);
  const Eigen::MatrixXd level = Eigen::MatrixXd::Constant(20, kChannels, 0.2);
  SensorNoise fitted;
  fitted.absolute[0] = 0.6;
  fitted.relative[0] = 0.08;
  fitted.slip_absolute = 0.01;
  SensorNoise noise = fitted;
  EXPECT_TRUE(strainedSensors(trial, level, {.slip = 0.01, .drawbar_pull_N = 1.0 / 1.6}, noise).empty());
  EXPECT_EQ(noise.absolute[0], 0.6);
  const auto strained = strainedSensors(trial, level, {.slip = 0.005, .drawbar_pull_N = 1.0 / 1.7}, noise);
  ASSERT_EQ(strained.size(), 2U);
  EXPECT_EQ(strained[0].column, "drawbar_pull_N");
  EXPECT_NEAR(strained[0].fitted, 1.0, 1e-12);
  EXPECT_EQ(strained[1].column, "slip");
  EXPECT_EQ(noise.absolute[0], 1.0 / 1.7);
  EXPECT_EQ(noise.relative[0], 0.0);
  EXPECT_EQ(noise.slip_absolute, 0.005);
  EXPECT_THAT(unstatedSensors(trial, {.slip = 0.005}), ElementsAre("drawbar_pull_N", "load_N"));
}

TEST(SensorNoise, WithoutSmoothRemovesLinearTrends) {
  const Trial trial = pullAlone(200);
  Eigen::MatrixXd line = trial.measured;
  for (int row = 0; row < 200; ++row) line(row, 0) = 3.0 - 4.0 * trial.slip[static_cast<std::size_t>(row)];
  // Closed form: a natural spline represents a line exactly.
  EXPECT_LT(withoutSmooth(trial, line, {"slip"}).col(0).norm(), 1e-9);
  EXPECT_TRUE(std::isnan(withoutSmooth(trial, line, {"slip"})(0, 1)));
}

// Property: the mean square of noise is unchanged, because the removed degrees of freedom are corrected for.
// Tolerance: four standard errors of the ratio over 300 tables of forty rows with four spline columns, a
// correction of a tenth.
TEST(SensorNoise, WithoutSmoothPreservesNoiseVariance) {
  const Trial trial = pullAlone(40);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double before = 0.0, after = 0.0;
  for (int table = 0; table < 300; ++table) {
    Eigen::MatrixXd error = trial.measured;
    for (int row = 0; row < 40; ++row) error(row, 0) = normal(random);
    before += error.col(0).squaredNorm();
    after += withoutSmooth(trial, error, {"slip"}).col(0).squaredNorm();
  }
  EXPECT_NEAR(after / before, 1.0, 0.02);
}

TEST(SensorNoise, AllButSlipKeepsOneOfTravelSpeedAndRimSpeed) {
  Trial trial;
  trial.covariates = {"slip", "load_N", "speed_mps"};
  EXPECT_THAT(allButSlip(trial), ElementsAre("load_N", "speed_mps"));
  trial.covariates.emplace_back("rim_speed_mps");
  EXPECT_THAT(allButSlip(trial), ElementsAre("load_N", "rim_speed_mps"));
}

}  // namespace sensor_noise_test
namespace noise_floor_test {

// Closed form: independent errors add in squares. Rows of load 50 N at slip 0.3, drawbar pull over load 0.2
// in every second row. Errors: 1 N of the load cell is 0.02, 10 % of the reading 0.02, a slip error of 3 % of
// 0.3 times a slope of 1 is 0.009, 2 % of the load times 0.5 is 0.01.
TEST(NoiseFloor, ErrorsAddInSquares) {
  Trial trial = trialOf(std::vector<double>(8, 0.3));
  trial.measured.setConstant(std::nan(""));
  for (int row = 0; row < 8; row += 2) trial.measured(row, 0) = 0.4;
  const Eigen::MatrixXd level = Eigen::MatrixXd::Constant(8, kChannels, 0.2);
  const InputSlopes slopes{Eigen::MatrixXd::Constant(8, kChannels, 1.0),
                           Eigen::MatrixXd::Constant(8, kChannels, 0.5)};
  SensorNoise noise = slipNoise(0.03);
  noise.absolute.fill(1.0);
  noise.relative.fill(0.1);
  noise.slip_absolute = 0.0;
  const auto floor = noiseFloor(trial, level, slopes, noise);
  EXPECT_NEAR(floor[0], std::sqrt(2.0 * 0.02 * 0.02 + 0.009 * 0.009 + 0.01 * 0.01), 1e-12);
  for (std::size_t c = 1; c < kChannels; ++c) EXPECT_TRUE(std::isnan(floor[c])) << c;
}

}  // namespace noise_floor_test

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
