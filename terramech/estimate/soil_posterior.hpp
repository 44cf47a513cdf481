#pragma once

#include <span>

#include <talus/terramech/estimate/soil_fit.hpp>

/// Bayesian estimate of the soil under a wheel with the complete Wong-Reece contact (ours).
///
/// Every reading (load W, torque T, sinkage z, slip i) has an error. Given a soil, the (z, i) of a sample
/// predict (W, T). The errors of z and i propagate through the derivative J_s of the contact, so that the
/// residual e = (W, T) - f(soil; z, i) has the covariance
///     S = diag(s_W^2, s_T^2) + J_s diag(s_z^2, s_i^2) J_s'
/// A fraction of outliers has ten times the standard deviation. The vehicle determines load and slip, the
/// soil determines sinkage and torque; the prior is therefore uniform in log W, not in log z, and each sample
/// has the factor d ln W / d ln z. Gauss-Newton finds the most likely soil of each class. The quadratic of
/// the likelihood there, truncated to the box of the class, is the importance distribution, and each draw is
/// weighted with the full likelihood. The estimate is the mean over the mixture of classes, which has the
/// least mean square error, not the mode.
namespace talus::terramech {

/// Returns the squared Mahalanobis distance of a soil from the mean in (c, tan phi), to compare with
/// ellipse_95. A component without posterior variance is omitted.
double strengthDistance(const SoilPosterior& posterior, const ContactSoil& soil);

/// Returns the posterior of the soil. Throws std::domain_error without samples or classes, or if no soil of
/// the prior explains the readings; std::invalid_argument for a sample not of a driven wheel (load > 0, 0 < z
/// < r, 0 <= slip <= 1) or options outside their range.
SoilPosterior fitSoil(const Wheel& wheel, std::span<const WheelSample> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

/// Returns the posterior for wheels of several sizes, with one value of k = k_c/b + k_phi for all. If
/// options.watch stops the computation, the posterior has no draws.
SoilPosterior fitSoil(std::span<const WheelReading> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

}  // namespace talus::terramech
