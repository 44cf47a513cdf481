#include <cmath>

#include <talus/terramech/calibration/search/trial_fit.hpp>

#include "calibration/noisy_rows.hpp"
#include "made_rows.hpp"

namespace talus::terramech {
namespace trial_fit_test {

bool always(double) {
  return true;
}

TEST(TrialFit, SharedRunErrorIsSeparatedFromRowNoise) {
  const TrialFit together(sand(), noisyTrial(sand(), 0.02, 0.1), false, always);
  const Whitening& whitening = together.rows().whitening();
  ASSERT_EQ(whitening.common.unit.size(), 160U);
  // Tolerance: 45 % is the standard error of a variance from ten offsets of 0.1.
  EXPECT_NEAR(std::sqrt(whitening.common.run(0, 0)), 0.1, 0.05);
  // Property: run offsets of 0.1 of the load do not increase the sensor noise, 2 % of a pull of about 0.3 W.
  const SensorNoise& noise = together.model().noise;
  EXPECT_LT(std::hypot(noise.absolute[0] / 80.0, 0.3 * noise.relative[0]), 0.03);
  const TrialFit alone(sand(), noisyTrial(sand(), 0.02), false, always);
  EXPECT_LT(std::sqrt(alone.rows().whitening().common.run(0, 0)), 0.01);
}

TEST(TrialFit, GivenSoilIsKeptAndUnknownSoilIsFitted) {
  RefinedModel start = sand();
  start.soil.friction_angle_rad = 0.4;
  const TrialFit given(start, noisyTrial(sand(), 0.02), false, always);
  EXPECT_EQ(given.model().soil.friction_angle_rad, 0.4);
  const TrialFit fitted(start, noisyTrial(sand(), 0.02), true, always);
  // Property: the friction angle of the rows is found from 480 readings of 2 %, although the initial value is
  // wrong by 0.15 rad.
  EXPECT_NEAR(fitted.model().soil.friction_angle_rad, 0.55, 0.05);
}

// Property: an absolute error of slip of 0.02 is recovered although no error is stated.
TEST(TrialFit, UnstatedSlipErrorMayBeAbsolute) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(5);
  std::normal_distribution<double> slip_error(0.0, 0.02);
  for (int k = 0; k < 240; ++k) {
    std::vector<double> row = wheelRow(madeSand(), 50.0 + (k * 7) % 60, 0.03 + 0.0034 * k, 0.02, random);
    row[1] += slip_error(random);
    rows.add(row);
  }
  const TrialFit fit(sand(), makeTrial(rows.telemetry(), sand()), true, always);
  EXPECT_NEAR(fit.model().noise.slipStd(0.1), 0.02, 0.005);
}

// Property: rows of straight wheels do not determine an effect of the slip angle, which keeps its value.
TEST(TrialFit, FitToStraightRowsKeepsEffectsOfTheSlipAngle) {
  RefinedModel model = sand();
  model.effects.push_back(
      {.name = "side_ploughing", .covariate = "slip_angle_rad", .parameters = {0.7, 1.0}});
  Trial trial = noisyTrial(model, 0.02);
  for (std::size_t row = 0; row < trial.states.size(); row += 2) trial.states[row].slip_angle_rad = 0.5;
  const TrialFit fit(model, trial, true, always);
  EXPECT_EQ(fit.model().effects[0].parameters, model.effects[0].parameters);
}

// Property: the model that generated the rows has a higher score than a model of another soil, for the noise
// of either model.
TEST(TrialFit, GeneratingModelScoresHigherThanAnotherSoil) {
  const TrialFit fit(sand(), noisyTrial(sand(), 0.02), false, always);
  RefinedModel softer = fit.model();
  softer.soil.frictional_modulus *= 0.5;
  EXPECT_GT(fit.scoreOf(fit.model()), fit.scoreOf(softer) + 10.0);
}

TEST(TrialFit, StrongestChannelIsThatOfTheFaultySensor) {
  RefinedModel model = sand();
  model.effects.push_back(
      {.name = "torque_offset", .covariate = "load_N", .channel = Channel::Torque, .parameters = {0.5}});
  const TrialFit fit(model, noisyTrial(sand(), 0.02), false, always);
  EXPECT_EQ(fit.strongest(0, 1), Channel::Torque);
}

}  // namespace trial_fit_test
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

// Loads of three levels that the load cell reads with an error of 4 %, and loads that scatter as much about the levels:
// the other readings follow the levels, or the cell.
TEST(CalibratedRows, LoadsAreSetIfTheOtherReadingsFollowTheirMeans) {
  for (const bool set : {true, false}) {
    MadeRows rows(wheelColumns());
    std::mt19937_64 random(6);
    std::normal_distribution<double> scatter(0.0, 0.04);
    for (int k = 0; k < 120; ++k) {
      const double level_N = 40.0 * std::pow(1.5, k % 3), other_N = level_N * std::exp(scatter(random));
      std::vector<double> row =
          wheelRow(sand().soil, set ? level_N : other_N, 0.1 + 0.05 * (k % 11), 0.01, random);
      row[0] = other_N;
      rows.add(row);
    }
    RefinedModel model = sand();
    SolvedContacts solved;
    CalibratedRows calibrated{makeTrial(rows.telemetry(), model)};
    calibrated.calibrate(model, solved);
    double square = 0.0;  // of the deviations from the levels
    for (int k = 0; k < 120; ++k) {
      const double load_N = calibrated.trial().states[static_cast<std::size_t>(k)].load_N;
      square += std::pow(std::log(load_N / (40.0 * std::pow(1.5, k % 3))), 2) / 120.0;
    }
    EXPECT_NEAR(std::sqrt(square), set ? 0.0 : 0.04, 0.01) << set;
  }
}

}  // namespace calibrated_rows_test

}  // namespace talus::terramech
