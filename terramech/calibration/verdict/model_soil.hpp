#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// How a soil is found under a model's effects.
struct ModelSoilOptions {
  /// Whose stated soil is the prior; none: vague, as where `trace` fits one.
  std::optional<RefinedModel> prior;
  std::optional<double> shear_modulus_m;  ///< K as stated [m], then not fitted
  double noise = 0.05;  ///< relative standard deviation of readings without one in the model file [-]
};

/// A soil, and how well it is known.
struct ModelSoil {
  Soil soil;
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();  ///< of (c [Pa], tan phi), priors included
  double misfit = 0.0;  ///< mean square of the whitened residuals; about 1 where model and noise hold
  std::vector<std::string> unseen;  ///< parameters as wide as the prior, or at the limit of their range
};

/// The most likely soil under rows of a wheel, by all channels that they measure, the effects of `model`
/// acting as its file states them: what they do to sinkage, torque and pull is not laid to the soil. Its own
/// soil is where the search starts, beside the one of a wheel of which nothing is known; the likelier end
/// counts.
ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options = {});

}  // namespace talus::terramech
