#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>
#include <talus/terramech/effects/channel_reading.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

/// Estimates the soil by method wong-reece without a model file: the posterior given the equilibrium of the
/// wheel. Throws the exceptions of estimateSoil(), and std::domain_error if no soil explains the rows
/// (noSoilExplains()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Returns true if a soil estimate from the table requires the complete wheel model. This is the case if a
/// side force is measured in rows with a slip angle above kStraightUpTo_rad, or if the side force in rows of
/// straight wheels exceeds kCoarse of the load (root mean square). Throws the exceptions of readTelemetry().
bool measuresSideForce(const TableFile& table);

/// Estimates the soil by method wong-reece from all channels of the table, with the effects of options.model
/// if given. Throws the exceptions of estimateSoil(). Throws std::domain_error if no soil explains the rows
/// (noSoilExplains()), or if a soil explains all columns except one of at least three (leavesUnexplained()).
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

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

/// Tests whether one soil explains all groups of rows. Returns a line of text that names the text column
/// (soil, run, ...) whose groups deviate from the fit significantly and by at least half a standard deviation
/// of the readings. Returns an empty text if there is no such column.
std::string groupsThatDisagree(const WheelRows& rows, const SoilPosterior& posterior,
                               const ReadingErrors& noise);

/// Options for a fit of the soil under the effects of a wheel model.
struct ModelSoilOptions {
  /// Model whose stated soil is the prior; empty: the vague prior of a soil that `talus trace` fits.
  std::optional<RefinedModel> prior;
  std::optional<double> shear_modulus_m;  ///< stated K [m], which is then not fitted; empty: K is fitted
  double noise = 0.05;  ///< relative standard deviation of sensors that the model file does not state [-]
};

/// Soil estimate with its uncertainty.
struct ModelSoil {
  Soil soil;
  /// Covariance of (c [Pa], tan phi), including priors.
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();
  double misfit = 0.0;  ///< mean square of the whitened residuals [-]; about 1 if model and noise are correct
  /// Parameters whose uncertainty is that of the prior, or that are at a bound of their range.
  std::vector<std::string> unseen;
};

/// Returns the maximum a posteriori soil for the rows of a trial, from all measured channels. The effects of
/// `model` are those stated in its file; their contribution to sinkage, torque and pull is not attributed to
/// the soil. The search starts from the unknown soil and, without a prior, also from the soil of the model;
/// the more likely result is returned.
ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options = {});

}  // namespace talus::terramech
