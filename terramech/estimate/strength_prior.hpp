#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_prior.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

namespace talus::terramech {

/// Gaussian prior of c and tan(phi) for the linear methods.
struct StrengthPrior {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();        ///< c [Pa], tan phi [-]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero for an exactly known value
  double probability = 1.0;  ///< the probabilities of several priors are scaled to sum 1
};

/// Returns the prior of (c, tan phi) from a soil's prior: std(tan phi) = std(phi)/cos(phi)^2.
StrengthPrior strengthPrior(const SoilPrior& soil);

/// Returns a fitted line combined with a mixture of priors by Bayes' rule (ours). The fit with its covariance
/// is one reading of (c, tan phi), and each prior is weighted by its likelihood of the fit. The result has
/// mean and covariance of the mixture; the remaining fields of `fit`, `unseen` included, are copied. Throws
/// std::domain_error if the fit has no covariance (fewer than three samples), std::invalid_argument without a
/// prior.
ShearStrength withPrior(const ShearStrength& fit, std::span<const StrengthPrior> priors);

}  // namespace talus::terramech
