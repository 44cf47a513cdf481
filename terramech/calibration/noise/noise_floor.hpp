#pragma once

#include <array>

#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// Root mean square of what errors of the sensors, and of slip and load by their slopes, leave in each scaled channel; NaN
/// where nothing is measured. `level` holds the readings of a model, rows x kChannels.
std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise);

}  // namespace talus::terramech
