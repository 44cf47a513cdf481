#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_prior.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

namespace talus::terramech {

/// A kind of soil as the linear methods see it: c and tan(phi), Gaussian.
struct StrengthPrior {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();        ///< c [Pa], tan phi [-]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero where a value is taken as known
  double probability = 1.0;                              ///< those of several are scaled to add up to 1
};

/// The same of a soil's prior: std(tan phi) = std(phi)/cos(phi)^2.
StrengthPrior strengthPrior(const SoilPrior& soil);

/// A fitted line and a prior, combined by Bayes' rule (ours): the fit with its covariance as one
/// reading of (c, tan phi), each kind of soil weighed by how well it foretold the fit. Mean and covariance of
/// the mixture; the rest of `fit` is kept, `unseen` too: it tells of the data. Throws std::domain_error where
/// the fit has no covariance, that is with fewer than three samples, std::invalid_argument without a prior.
ShearStrength withPrior(const ShearStrength& fit, std::span<const StrengthPrior> priors);

}  // namespace talus::terramech
