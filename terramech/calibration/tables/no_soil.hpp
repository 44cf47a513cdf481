#pragma once

#include <string>

#include <Eigen/Core>

#include <talus/terramech/calibration/tables/soil_estimate.hpp>
#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::terramech {

/// Mean square of the whitened residuals above which the model does not describe the rows [-].
inline constexpr double kMisfit = 3.0;

/// Root mean square of residuals, of the load or the radius, that a model of a rigid wheel may leave [-].
inline constexpr double kCoarse = 0.1;

/// Readings of rows, and what the soil found foretells of them.
struct SoilAnswer {
  Eigen::MatrixXd measured;   ///< rows x kChannels [-] as Reading::scaled(); NaN: not measured
  Eigen::MatrixXd predicted;  ///< the same
  double misfit = 1.0;        ///< mean square of the whitened residuals [-]
};

/// The column of telemetry that a channel is read from, such as "side_force_N".
const char* columnOf(Channel channel);

/// A column of the table and what the soil leaves of it.
struct UnexplainedColumn {
  std::string column;  ///< empty: none
  double left = 0.0;   ///< root mean square of the residuals over that of the readings [-]
};

/// The channel of which the soil leaves most, of those of which it leaves more than half and more than 0.1 of the load or the radius.
/// The bounds are ours, not from the literature: they do not depend on the stated noise, and soils of measured sand leave less.
UnexplainedColumn unexplained(const SoilAnswer& answer);

/// Whether the soil leaves more than half of that channel and more than 0.1 of the load or the radius.
bool leavesUnexplained(const SoilAnswer& answer, Channel channel);

/// Why no soil comes near the rows; empty where one does: the strength found is that of a soil (SoilEstimate::implausible()), and
/// their misfit is at most kMisfit or no column is unexplained.
std::string noSoilExplains(const SoilEstimate& estimate, const SoilAnswer& answer);

}  // namespace talus::terramech
