#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/terramech/trace/covariate_tests.hpp>
#include <talus/terramech/trace/input_calibration.hpp>
#include <talus/terramech/trace/sensor_noise.hpp>

namespace talus::terramech {
namespace {

SensorNoise slipNoise(double relative) {
  SensorNoise noise;
  noise.slip_relative = relative;
  noise.load_relative = 0.02;
  return noise;
}

/// Rows whose measured slips are given; both speeds agree with them.
Trial trialOf(const std::vector<double>& slips) {
  Trial trial;
  for (double slip : slips) {
    WheelState s{.load_N = 50.0, .slip = slip, .speed_mps = 0.1 * (1.0 - slip), .rim_speed_mps = 0.1};
    trial.states.push_back(s);
    trial.load_N.push_back(s.load_N);
    trial.slip.push_back(slip);
  }
  trial.slip_variance = trial.load_variance = Eigen::VectorXd::Zero(trial.rows());
  trial.measured = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  return trial;
}

std::vector<double> scattered(double level, double std, int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(level, std);
  std::vector<double> all;
  for (int k = 0; k < count; ++k) all.push_back(normal(random));
  return all;
}

TEST(SensorNoise, OneLevelOfSlipIsNotSeenToVary) {
  EXPECT_FALSE(slipIsSeen(trialOf(scattered(0.3, 0.01, 200)), slipNoise(0.03)));
  // Property: scatter beyond twice the error is seen, however large an error is claimed.
  EXPECT_TRUE(slipIsSeen(trialOf(scattered(0.3, 0.025, 200)), slipNoise(0.03)));
  EXPECT_TRUE(slipIsSeen(trialOf(scattered(0.3, 0.1, 200)), slipNoise(0.9)));
}

TEST(SensorNoise, ErrorsAboutOneLevelAreTakenOut) {
  // Closed form: scatter equal to the error keeps nothing of it; the speed over ground, had from the slip,
  // follows.
  const std::vector<double> measured = scattered(0.4, 0.012, 400);
  Trial trial = trialOf(measured);
  double mean = 0.0;
  for (double slip : measured) mean += slip / 400.0;
  calibrateInputs(trial, slipNoise(0.05));
  for (const WheelState& s : trial.states) {
    EXPECT_NEAR(s.slip, mean, 1e-12);
    EXPECT_NEAR(s.speed_mps, 0.1 * (1.0 - mean), 1e-12);
  }
}

TEST(SensorNoise, OnlyASpeedThatAgreesWithTheSlipFollowsIt) {
  WheelState own{.slip = 0.2, .speed_mps = 0.05, .rim_speed_mps = 0.1};
  setSlip(own, 0.3);
  EXPECT_EQ(own.speed_mps, 0.05);
  WheelState tied{.slip = 0.2, .speed_mps = 0.08, .rim_speed_mps = 0.1};
  setSlip(tied, 0.3);
  EXPECT_NEAR(tied.speed_mps, 0.07, 1e-15);
  EXPECT_EQ(tied.slip, 0.3);
}

TEST(SensorNoise, TheirMeanErrsLess) {
  // Closed form: sigma / sqrt(n).
  const Eigen::VectorXd shared = sharedSlipStd(trialOf(std::vector<double>(100, 0.5)), slipNoise(0.04));
  ASSERT_EQ(shared.size(), 100);
  EXPECT_NEAR(shared[7], 0.02 / 10.0, 1e-12);
}

/// True slips over a range, rims that make one travel speed of them; measured slips err by `relative`.
Trial atOneSpeed(double relative, double speed_scatter) {
  const std::vector<double> error = scattered(0.0, 1.0, 120), other = scattered(0.0, speed_scatter, 120);
  std::vector<double> slips;
  for (int k = 0; k < 120; ++k)
    slips.push_back((0.1 + 0.005 * k) * (1.0 + relative * error[static_cast<std::size_t>(k)]));
  Trial trial = trialOf(slips);
  for (std::size_t k = 0; k < 120; ++k) {
    WheelState& s = trial.states[k];
    s.rim_speed_mps = 0.02 * std::exp(other[119 - k]) / (0.9 - 0.005 * static_cast<double>(k));
    s.speed_mps = s.rim_speed_mps * (1.0 - s.slip);
  }
  return trial;
}

TEST(SensorNoise, OneSpeedOfTravelTellsTheSlips) {
  Trial trial = atOneSpeed(0.04, 0.0);
  ASSERT_TRUE(slipIsSeen(trial, slipNoise(0.04)));
  EXPECT_FALSE(speedIsSeen(trial, slipNoise(0.04)));
  EXPECT_GT(sharedSlipStd(trial, slipNoise(0.04)).size(), 0);
  calibrateInputs(trial, slipNoise(0.04));
  double worst = 0.0;
  for (std::size_t k = 0; k < 120; ++k)
    worst = std::max(worst, std::abs(trial.states[k].slip - (0.1 + 0.005 * static_cast<double>(k))));
  // Property: errors of 0.004 to 0.03 become what is left of them in the mean speed.
  EXPECT_LT(worst, 0.003);
}

TEST(SensorNoise, SpeedsThatVaryTellNoSlips) {
  EXPECT_TRUE(speedIsSeen(atOneSpeed(0.04, 0.3), slipNoise(0.04)));
  Trial own = atOneSpeed(0.04, 0.0);
  own.states[3].speed_mps *= 1.1;
  EXPECT_TRUE(speedIsSeen(own, slipNoise(0.04)));
  EXPECT_EQ(sharedSlipStd(own, slipNoise(0.04)).size(), 0);
}

TEST(CovariateTests, AnErrorThatAllRowsShareIsNotAConstant) {
  // Property: an offset of two standard deviations of a shared error is certain without it, and not with it.
  const std::vector<double> wobble = scattered(0.0, 0.01, 120);
  Trial trial = trialOf(std::vector<double>(120, 0.3));
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 1; c < kChannels; ++c) trial.measured(row, c) = std::nan("");
  Eigen::MatrixXd residual = trial.measured;
  for (int row = 0; row < trial.rows(); ++row)
    residual(row, 0) = 0.02 + wobble[static_cast<std::size_t>(row)];
  SensorNoise noise;
  noise.absolute[0] = 0.5;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  const Whitening white = whitening(trial, none, {none, none}, noise);
  TestPlan plan;
  plan.nuisance_whitened = plan.nuisance_marginal = Eigen::MatrixXd(trial.rows() * kChannels, 0);
  plan.flips = 999;
  const auto p = [&] {
    return testCovariates(trial, white, residual, Eigen::VectorXd::Zero(trial.rows()), plan).front().p_value;
  };
  EXPECT_LT(p(), 0.002);
  plan.shared_error = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  plan.shared_error.col(0).setConstant(0.01);
  const double shared = p();
  EXPECT_GT(shared, 0.02);
  EXPECT_LT(shared, 0.09);
}

}  // namespace
}  // namespace talus::terramech
