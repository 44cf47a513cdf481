#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/talus.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

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

/// How to fit.
struct SoilFitOptions {
  ReadingErrors noise = {};
  double outlier_share = 0.01;  ///< of samples that err ten times as much, [0, 0.5)
  int draws = 256;              ///< importance samples a class, >= 16
  ProgressMonitor watch = {};   ///< followed and stopped by it where samples are many
};

/// One soil out of the posterior.
struct SoilDraw {
  ContactSoil soil;
  double weight = 0.0;  ///< those of all draws add up to 1
  int soil_class = 0;   ///< index into the prior
};

/// A range that holds the truth with 95 % probability.
struct CredibleInterval {
  double low = 0.0;
  double high = 0.0;
};

/// What is believed after the samples.
struct SoilPosterior {
  ContactSoil mean;
  SoilMatrix covariance = SoilMatrix::Zero();                     ///< of (c, phi, n, k, K), SI
  double tan_friction = 0.0;                                      ///< mean of tan(phi) [-]
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();  ///< of (c [Pa], tan phi)
  /// (x - mean)' strength_covariance^-1 (x - mean) <= this, x = (c, tan phi), holds 95 % of the
  /// posterior. 5.99 were it Gaussian; less where the bounds of a class cut it off.
  double ellipse_95 = 0.0;
  CredibleInterval cohesion_Pa;
  CredibleInterval friction_angle_rad;
  CredibleInterval shear_modulus_m;
  std::vector<double> class_probabilities;  ///< in the order of the prior
  std::vector<SoilDraw> draws;
  double effective_draws = 0.0;  ///< of the weighted draws; below about 20 the figures are rough
  double misfit =
      0.0;  ///< mean square of the whitened residuals of the best class; about 1 when model and noise hold
  std::vector<std::string> unseen;  ///< parameters that the samples said little about, each with the reason
};

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
