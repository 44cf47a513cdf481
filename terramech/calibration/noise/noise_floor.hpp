#pragma once

#include <array>

#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// Returns the noise floor: the root mean square of each scaled channel that sensor errors cause. The floor
/// includes the errors of slip and load, which act through `slopes`; NaN for channels without measurements.
/// `level` contains a model's predictions, rows x kChannels.
std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise);

}  // namespace talus::terramech
