#pragma once

#include <span>

#include <talus/terramech/estimate/soil_fit.hpp>

/// Bayesian estimate of the soil under a wheel by the complete Wong-Reece wheel-soil contact (ours).
///
/// Every reading (load W, torque T, sinkage z, slip i) has an error. Given a soil, the sinkage and slip (z,
/// i) of a sample predict (W, T) = f(soil; z, i). The errors of z and i propagate through the derivative J_s
/// of f with respect to (z, i). The residual e = (W, T) - f(soil; z, i) therefore has the covariance
///     S = diag(s_W^2, s_T^2) + J_s diag(s_z^2, s_i^2) J_s'
/// with the standard deviations s of the readings. A fraction of the samples are outliers with ten times
/// these standard deviations. The vehicle determines load and slip, and the soil determines sinkage and
/// torque. The prior is therefore uniform in log W, not in log z, and each sample has the factor d ln W / d
/// ln z. Gauss-Newton finds the mode (most likely soil) of each soil class. The quadratic of the
/// log-likelihood about the mode, truncated to the bounds of the class, gives the importance distribution;
/// each draw is weighted with the full likelihood. The estimate is the mean over the mixture of classes,
/// which has the least mean square error.
namespace talus::terramech {

/// Returns the squared Mahalanobis distance of a soil from the posterior mean in (c, tan phi), for comparison
/// with SoilPosterior::ellipse_95. A component without posterior variance is omitted.
double strengthDistance(const SoilPosterior& posterior, const ContactSoil& soil);

/// Returns the posterior of the soil, given samples of one wheel of radius r. Throws std::domain_error
/// without samples or classes, or if no soil of the prior explains the readings. Throws std::invalid_argument
/// for a sample that is not of a driven wheel (load > 0, 0 < z < r, 0 <= slip <= 1) and for options outside
/// their range.
SoilPosterior fitSoil(const Wheel& wheel, std::span<const WheelSample> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

/// Returns the posterior of the soil, given samples of wheels of several sizes. One value of the sinkage
/// modulus k = k_c/b + k_phi is used for all widths b. If options.watch stops the computation, the posterior
/// has no draws.
SoilPosterior fitSoil(std::span<const WheelReading> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

}  // namespace talus::terramech
