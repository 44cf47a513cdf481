#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Options for a soil fit under a model's effects.
struct ModelSoilOptions {
  /// Model whose stated soil is the prior; empty: vague prior, as for a soil fitted by `talus trace`.
  std::optional<RefinedModel> prior;
  std::optional<double> shear_modulus_m;  ///< stated K [m], which is not fitted
  double noise = 0.05;  ///< relative standard deviation of readings without one in the model file [-]
};

/// A soil estimate with its uncertainty.
struct ModelSoil {
  Soil soil;
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();  ///< of (c [Pa], tan phi), priors included
  double misfit = 0.0;  ///< mean square of the whitened residuals; about 1 if model and noise are correct
  std::vector<std::string> unseen;  ///< parameters with the prior's width, or at the limit of their range
};

/// Maximum a posteriori soil for rows of a wheel from all measured channels, with the effects of `model` as
/// stated in its file; the contribution of the effects to sinkage, torque and pull is not attributed to the
/// soil. The search starts from the unknown soil and, without a prior, also from the soil of the model; the
/// more likely result is returned.
ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options = {});

}  // namespace talus::terramech
