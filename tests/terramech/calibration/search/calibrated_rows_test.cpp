#include <cmath>

#include <talus/terramech/calibration/search/calibrated_rows.hpp>

#include "calibration/noisy_rows.hpp"

namespace talus::terramech {
namespace calibrated_rows_test {

// Property: whitened residuals have unit variance. Tolerance: 6.5 % is the standard error of a variance from
// 480 values.
TEST(CalibratedRows, WhitenedResidualsHaveUnitVariance) {
  for (const double noise : {0.01, 0.05}) {
    RefinedModel model = sand();
    SolvedContacts solved;
    CalibratedRows rows{noisyTrial(model, noise)};
    rows.calibrate(model, solved);
    EXPECT_NEAR(rows.white().squaredNorm() / 480.0, 1.0, 0.2) << noise;
  }
}

TEST(CalibratedRows, RecoversSensorNoise) {
  RefinedModel model = sand();
  SolvedContacts solved;
  CalibratedRows{noisyTrial(model, 0.05)}.calibrate(model, solved);
  // Closed form: 5 % of a torque of about T = 0.3 r W = 2.4 Nm, absolute and relative parts combined.
  EXPECT_NEAR(std::hypot(model.noise.absolute[2], 2.4 * model.noise.relative[2]), 0.12, 0.04);
}

TEST(CalibratedRows, LevelOfAnotherModelKeepsTheNoise) {
  RefinedModel model = sand();
  SolvedContacts solved;
  CalibratedRows rows{noisyTrial(model, 0.02)};
  rows.calibrate(model, solved);
  const Eigen::MatrixXd std = rows.whitening().std, level = rows.level();
  RefinedModel softer = model;
  softer.soil.frictional_modulus *= 0.5;
  rows.compare(softer, solved);
  EXPECT_EQ(rows.whitening().std, std);
  EXPECT_GT((rows.level() - level).cwiseAbs().maxCoeff(), 0.0);
  // Property: the measured value is the sum of level and residual; NaN for missing measurements.
  EXPECT_NEAR((rows.trial().measured - rows.level() - rows.residual()).leftCols(3).norm(), 0.0, 1e-12);
}

}  // namespace calibrated_rows_test
}  // namespace talus::terramech
