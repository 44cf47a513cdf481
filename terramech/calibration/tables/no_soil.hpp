#pragma once

#include <string>

#include <Eigen/Core>

#include <talus/terramech/calibration/tables/soil_estimate.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Mean square of the whitened residuals above which the model of the estimate is rejected [-].
inline constexpr double kMisfit = 3.0;

/// Root mean square residual, divided by load or radius, that is acceptable for a rigid-wheel model [-].
inline constexpr double kCoarse = 0.1;

/// Measured channels of the rows, and the predictions for the estimated soil.
struct SoilAnswer {
  Eigen::MatrixXd measured;  ///< scaled channels (Reading::scaled()), rows x kChannels [-]; NaN: not measured
  Eigen::MatrixXd predicted;  ///< predictions of `measured`
  double misfit = 1.0;        ///< mean square of the whitened residuals [-]
};

/// Returns the telemetry column of a channel, for example "side_force_N".
const char* columnOf(Channel channel);

/// Column of the table, and the share of its readings that the soil does not explain.
struct UnexplainedColumn {
  std::string column;  ///< name; empty: no column is unexplained
  double left = 0.0;   ///< root mean square of the residuals over that of the readings [-]
};

/// Returns the column with the largest unexplained share, among those for which the residual exceeds half of
/// the readings and 0.1 of load or radius (root mean square). The limits are ours: they are independent of
/// the stated noise, and fits to measured sand do not exceed these limits.
UnexplainedColumn unexplained(const SoilAnswer& answer);

/// Returns true if the residual of a channel exceeds half of its readings and 0.1 of load or radius (root
/// mean square).
bool leavesUnexplained(const SoilAnswer& answer, Channel channel);

/// Returns the reason why no soil explains the rows. Returns an empty text if the estimated strength is
/// plausible (SoilEstimate::implausible()) and if, in addition, the misfit is at most kMisfit or no column is
/// unexplained.
std::string noSoilExplains(const SoilEstimate& estimate, const SoilAnswer& answer);

}  // namespace talus::terramech
