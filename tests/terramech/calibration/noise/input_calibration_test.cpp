#include <cmath>

#include <talus/terramech/calibration/noise/input_calibration.hpp>

#include "calibration/slip_rows.hpp"

namespace talus::terramech {
namespace input_calibration_test {

TEST(InputCalibration, SlipVariesOnlyIfScatterExceedsTwiceItsError) {
  EXPECT_FALSE(slipIsSeen(trialOf(scattered(0.3, 0.01, 200)), slipNoise(0.03)));
  // Property: scatter beyond twice the error is recognised as variation of slip, also for a large stated
  // error.
  EXPECT_TRUE(slipIsSeen(trialOf(scattered(0.3, 0.025, 200)), slipNoise(0.03)));
  EXPECT_TRUE(slipIsSeen(trialOf(scattered(0.3, 0.1, 200)), slipNoise(0.9)));
}

TEST(InputCalibration, ErrorsAboutOneSlipLevelAreRemoved) {
  // Closed form: scatter equal to the error is removed entirely; the speed over ground, computed from the
  // slip, is updated.
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

TEST(InputCalibration, SpeedIsUpdatedOnlyIfConsistentWithSlip) {
  WheelState own{.slip = 0.2, .speed_mps = 0.05, .rim_speed_mps = 0.1};
  setSlip(own, 0.3);
  EXPECT_EQ(own.speed_mps, 0.05);
  WheelState tied{.slip = 0.2, .speed_mps = 0.08, .rim_speed_mps = 0.1};
  setSlip(tied, 0.3);
  EXPECT_NEAR(tied.speed_mps, 0.07, 1e-15);
  EXPECT_EQ(tied.slip, 0.3);
}

TEST(InputCalibration, StdOfMeanSlipIsSigmaOverRootN) {
  // Closed form: sigma / sqrt(n).
  const Eigen::VectorXd shared = sharedSlipStd(trialOf(std::vector<double>(100, 0.5)), slipNoise(0.04));
  ASSERT_EQ(shared.size(), 100);
  EXPECT_NEAR(shared[7], 0.02 / 10.0, 1e-12);
}

/// Rows at slips over a range, with rim speeds for a constant travel speed. The measured slips have the
/// relative error `relative`.
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

TEST(InputCalibration, ConstantTravelSpeedDeterminesSlips) {
  Trial trial = atOneSpeed(0.04, 0.0);
  ASSERT_TRUE(slipIsSeen(trial, slipNoise(0.04)));
  EXPECT_FALSE(setSpeeds(trial, slipNoise(0.04)).empty());
  EXPECT_FALSE(inputsAreSeen(trial, slipNoise(0.04)));
  EXPECT_GT(sharedSlipStd(trial, slipNoise(0.04)).size(), 0);
  calibrateInputs(trial, slipNoise(0.04));
  double worst = 0.0;
  for (std::size_t k = 0; k < 120; ++k)
    worst = std::max(worst, std::abs(trial.states[k].slip - (0.1 + 0.005 * static_cast<double>(k))));
  // Property: slip errors of 0.004 to 0.03 are reduced to the error of the mean speed.
  EXPECT_LT(worst, 0.003);
}

TEST(InputCalibration, SpeedConstantWithinEachRunDeterminesSlips) {
  Trial trial = atOneSpeed(0.04, 0.0);
  for (std::size_t k = 0; k < 120; ++k) {
    WheelState& s = trial.states[k];
    trial.run[k] = static_cast<int>(k) % 6;
    s.rim_speed_mps *= std::pow(1.5, trial.run[k]);
    s.speed_mps = s.rim_speed_mps * (1.0 - s.slip);
  }
  EXPECT_EQ(setSpeeds(trial, slipNoise(0.04)), trial.run);
  EXPECT_TRUE(inputsAreSeen(trial, slipNoise(0.04)));
  calibrateInputs(trial, slipNoise(0.04));
  double square = 0.0;
  for (std::size_t k = 0; k < 120; ++k) {
    square += std::pow(trial.states[k].slip - (0.1 + 0.005 * static_cast<double>(k)), 2) / 120.0;
    EXPECT_NEAR(trial.states[k].speed_mps, trial.states[static_cast<std::size_t>(trial.run[k])].speed_mps,
                1e-3);
  }
  // Property: slip errors of 4 % at slips of 0.4, 0.017 rms, are reduced by about 1 / sqrt(20), the means of
  // 20 rows.
  EXPECT_LT(std::sqrt(square), 0.007);
}

TEST(InputCalibration, VaryingSpeedsDoNotDetermineSlips) {
  EXPECT_TRUE(setSpeeds(atOneSpeed(0.04, 0.3), slipNoise(0.04)).empty());
  Trial own = atOneSpeed(0.04, 0.0);
  own.states[3].speed_mps *= 1.1;
  EXPECT_TRUE(setSpeeds(own, slipNoise(0.04)).empty());
  EXPECT_EQ(sharedSlipStd(own, slipNoise(0.04)).size(), 0);
}

/// Twenty runs of ten rows, each at a load of its own. The true loads scatter about it by `true_scatter`, and the
/// readings have an error of 2 %.
Trial setCampaign(double true_scatter) {
  Trial trial = trialOf(scattered(0.3, 0.1, 200));
  const std::vector<double> error = scattered(0.0, 0.02, 200), own = scattered(0.0, true_scatter, 400);
  for (std::size_t k = 0; k < 200; ++k) {
    trial.run[k] = static_cast<int>(k / 10);
    trial.load_N[k] = (40.0 + 3.0 * trial.run[k]) * std::exp(error[k] + own[399 - k]);
    trial.states[k].load_N = trial.load_N[k];
  }
  return trial;
}

TEST(InputCalibration, SetLoadIsTheMeanOfItsRun) {
  Trial trial = setCampaign(0.0);
  const auto set = setLoads(trial);
  ASSERT_TRUE(set);
  calibrateInputs(trial, slipNoise(0.04), set);
  for (int k = 0; k < 200; ++k) {
    const auto row = static_cast<std::size_t>(k);
    EXPECT_EQ(trial.states[row].load_N, set->load_N[k]);
    EXPECT_NEAR(trial.load_variance[k], 4e-4 / 10.0, 1e-12);  // Closed form: sigma^2/n of ten readings
  }
}

TEST(InputCalibration, ContinuousLoadsAndDrivesHaveNoSetLoad) {
  Trial drive = setCampaign(0.0);
  drive.moment.assign(200, 0);
  EXPECT_FALSE(setLoads(drive));
  Trial wide = setCampaign(0.3);
  EXPECT_FALSE(setLoads(wide));
}

}  // namespace input_calibration_test
}  // namespace talus::terramech
