#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>

namespace talus::terramech {

/// Estimates the soil from plate tests by method bevameter. Throws the exceptions of estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Estimates the soil by one of the linear methods sojourner, iagnemma and linear-offset. Throws the
/// exceptions of estimateSoil().
SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Estimates the soil by method wong-reece without a model file: the posterior given the equilibrium of the
/// wheel. Throws the exceptions of estimateSoil(), and std::domain_error if the strength is that of no soil
/// (SoilEstimate::implausible()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Returns true if a soil estimate from the table requires the complete wheel model. This is the case if a
/// side force is measured in rows with a slip angle above kStraightUpTo_rad, or if the side force in rows of
/// straight wheels exceeds a tenth of the load (root mean square). Throws the exceptions of readTelemetry().
bool measuresSideForce(const TableFile& table);

/// Estimates the soil by method wong-reece from all channels of the table, with the effects of options.model
/// if given. Throws the exceptions of estimateSoil(), and std::domain_error if the strength is that of no soil
/// (SoilEstimate::implausible()) or if the nearest soil leaves more than half of a column unexplained.
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

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
