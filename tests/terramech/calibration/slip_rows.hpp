#pragma once

#include <random>
#include <vector>

#include <talus/terramech/calibration.hpp>

namespace talus::terramech {

inline SensorNoise slipNoise(double relative) {
  SensorNoise noise;
  noise.slip_relative = relative;
  noise.load_relative = 0.02;
  return noise;
}

/// Rows with the given measured slips, and with speeds consistent with these slips.
inline Trial trialOf(const std::vector<double>& slips) {
  Trial trial;
  for (double slip : slips) {
    WheelState s{.load_N = 50.0, .slip = slip, .speed_mps = 0.1 * (1.0 - slip), .rim_speed_mps = 0.1};
    trial.states.push_back(s);
    trial.load_N.push_back(s.load_N);
    trial.slip.push_back(slip);
    trial.run.push_back(static_cast<int>(trial.run.size()));
  }
  trial.slip_variance = trial.load_variance = Eigen::VectorXd::Zero(trial.rows());
  trial.measured = Eigen::MatrixXd::Zero(trial.rows(), kChannels);
  return trial;
}

inline std::vector<double> scattered(double level, double std, int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(level, std);
  std::vector<double> all;
  for (int k = 0; k < count; ++k) all.push_back(normal(random));
  return all;
}

}  // namespace talus::terramech
