#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Gaussian prior of cohesion c and tan(phi) for the linear methods, which fit a Mohr-Coulomb line.
struct StrengthPrior {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< mean of c [Pa] and tan phi [-]
  /// Covariance of (c, tan phi); zero for an exactly known value.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double probability = 1.0;  ///< weight among several priors; their weights are scaled to sum 1
};

/// Returns the prior of (c, tan phi) from the prior of a soil, with std(tan phi) = std(phi)/cos(phi)^2.
StrengthPrior strengthPrior(const SoilPrior& soil);

/// Returns a fitted Mohr-Coulomb line combined with a mixture of priors by Bayes' rule (ours). The fit with
/// its covariance counts as one reading of (c, tan phi); each prior is weighted by its likelihood of the fit.
/// The result contains mean and covariance of the mixture; the remaining fields of `fit`, including `unseen`,
/// are copied. Throws std::domain_error if the fit has no covariance (fewer than three samples), and
/// std::invalid_argument without a prior.
ShearStrength withPrior(const ShearStrength& fit, std::span<const StrengthPrior> priors);

}  // namespace talus::terramech
