#pragma once

#include <span>

#include <talus/terramech/estimate/soil_fit.hpp>

/// The soil under a wheel by Bayes' rule on the whole Wong-Reece contact (ours).
///
/// Every reading errs, z and i as well as W and T. Given a soil, a sample's (z, i) predict (W, T); the errors
/// of z and i are carried through the contact's derivative J_s, so the residual e = (W, T) - f(soil; z, i)
/// has covariance
///     S = diag(s_W^2, s_T^2) + J_s diag(s_z^2, s_i^2) J_s'
/// with a share of outliers of ten times the scatter. Load and slip are what the vehicle makes them, sinkage
/// and torque what the soil answers: a flat prior of log W, not of log z, which gives each sample the factor
/// d ln W / d ln z. In each class of the prior Gauss-Newton finds the most likely soil; the likelihood's
/// quadratic there, cut to the class' box, proposes importance samples that are weighed with the likelihood
/// itself. What is returned is the mean over the mixture of classes, which has the least mean square error,
/// not the mode.
namespace talus::terramech {

/// Squared distance of a soil from the mean in units of the posterior's covariance of (c, tan phi): compare
/// with ellipse_95. What the prior fixes does not count.
double strengthDistance(const SoilPosterior& posterior, const ContactSoil& soil);

/// Throws std::domain_error without a sample, std::invalid_argument for a sample that is not of a driven
/// wheel (load > 0, 0 < z < r, 0 <= slip <= 1) or options out of range.
SoilPosterior fitSoil(const Wheel& wheel, std::span<const WheelSample> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

/// The same on wheels of several sizes. The soil's k = k_c/b + k_phi is taken as one value under all of them.
/// Stopped by the options' watch it returns a posterior without draws.
SoilPosterior fitSoil(std::span<const WheelReading> samples, const SoilMixture& prior,
                      const SoilFitOptions& options = {});

}  // namespace talus::terramech
