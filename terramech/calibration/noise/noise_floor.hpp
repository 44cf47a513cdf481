#pragma once

#include <array>

#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// Root mean square of each scaled channel due to sensor errors, including errors of slip and load through
/// their slopes; NaN for channels without measurements. `level` contains a model's predictions, rows x
/// kChannels.
std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise);

}  // namespace talus::terramech
