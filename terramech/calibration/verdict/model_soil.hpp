#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

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
