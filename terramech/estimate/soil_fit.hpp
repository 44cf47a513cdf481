#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// Options and result of a soil fit: the types of soil_posterior.hpp.
namespace talus::terramech {

/// Options of a soil fit.
struct SoilFitOptions {
  ReadingErrors noise = {};     ///< errors of the readings
  double outlier_share = 0.01;  ///< expected fraction of samples with ten times the error, [0, 0.5]
  int draws = 256;              ///< importance samples per class, >= 16
  ProgressMonitor watch = {};   ///< progress and cancellation for many samples
};

/// One soil drawn from the posterior.
struct SoilDraw {
  ContactSoil soil;
  double weight = 0.0;  ///< the weights of all draws have sum 1
  int soil_class = 0;   ///< index into the prior
};

/// Interval that contains the true value with 95 % probability.
struct CredibleInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Posterior of the soil: summary and weighted draws.
struct SoilPosterior {
  ContactSoil mean;  ///< mean of c, phi, n, k, K (soil_mixture.hpp); c1, c2 of the draw with the largest
                     ///< weight
  SoilMatrix covariance = SoilMatrix::Zero();                     ///< of (c, phi, n, k, K), SI
  double tan_friction = 0.0;                                      ///< mean of tan(phi) [-]
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();  ///< of (c [Pa], tan phi)
  /// 95 % of the posterior lie where (x - mean)' strength_covariance^-1 (x - mean) <= ellipse_95, x = (c, tan
  /// phi). ellipse_95 is 5.99 for a Gaussian posterior, and less if the bounds of a class truncate the
  /// posterior.
  double ellipse_95 = 0.0;
  CredibleInterval cohesion_Pa;
  CredibleInterval friction_angle_rad;
  CredibleInterval shear_modulus_m;
  std::vector<double> class_probabilities;  ///< in the order of the prior
  std::vector<SoilDraw> draws;
  /// Effective number of weighted draws; below about 20 the results are inaccurate.
  double effective_draws = 0.0;
  /// Mean square of the whitened residuals of the best class; about 1 if model and noise are right.
  double misfit = 0.0;
  std::vector<std::string> unseen;  ///< parameters that the samples hardly constrain, each with the reason
};

}  // namespace talus::terramech
