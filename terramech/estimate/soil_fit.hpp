#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// How a soil is fitted to readings, and what is believed after it: the types of soil_posterior.hpp.
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
  /// Mean square of the whitened residuals of the best class; about 1 when model and noise hold.
  double misfit = 0.0;
  std::vector<std::string> unseen;  ///< parameters that the samples said little about, each with the reason
};

}  // namespace talus::terramech
