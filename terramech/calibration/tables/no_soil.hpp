#pragma once

#include <string>

#include <Eigen/Core>

#include <talus/terramech/calibration/tables/soil_estimate.hpp>
#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::terramech {

/// Mean square of the whitened residuals above which the model is rejected [-].
inline constexpr double kMisfit = 3.0;

/// Root mean square of the residuals over load or radius that is acceptable for a rigid-wheel model [-].
inline constexpr double kCoarse = 0.1;

/// Readings of rows, and predictions for the estimated soil.
struct SoilAnswer {
  Eigen::MatrixXd measured;   ///< rows x kChannels [-] as Reading::scaled(); NaN: not measured
  Eigen::MatrixXd predicted;  ///< same layout
  double misfit = 1.0;        ///< mean square of the whitened residuals [-]
};

/// Telemetry column of a channel, such as "side_force_N".
const char* columnOf(Channel channel);

/// A column of the table, and the share that the soil leaves unexplained.
struct UnexplainedColumn {
  std::string column;  ///< empty: no column
  double left = 0.0;   ///< root mean square of the residuals over that of the readings [-]
};

/// The channel with the largest unexplained share, if more than half of its readings and more than 0.1 of
/// load or radius are unexplained. The bounds are ours, not from the literature: they are independent of the
/// stated noise, and soils of measured sand are below them.
UnexplainedColumn unexplained(const SoilAnswer& answer);

/// Returns true if more than half of the channel and more than 0.1 of load or radius are unexplained.
bool leavesUnexplained(const SoilAnswer& answer, Channel channel);

/// Returns the reason why no soil explains the rows. Returns an empty text if the estimated strength is
/// plausible (SoilEstimate::implausible()), and either the misfit is at most kMisfit or no column is
/// unexplained.
std::string noSoilExplains(const SoilEstimate& estimate, const SoilAnswer& answer);

}  // namespace talus::terramech
