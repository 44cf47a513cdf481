#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// Options and result of the Bayesian soil fit in soil_posterior.hpp.
namespace talus::terramech {

/// Options of a soil fit.
struct SoilFitOptions {
  ReadingErrors noise = {};  ///< standard deviations of the readings
  /// Expected fraction of outliers (samples with ten times the error), [0, 0.5].
  double outlier_share = 0.01;
  int draws = 256;             ///< number of importance samples per soil class, >= 16
  ProgressMonitor watch = {};  ///< progress and cancellation of a fit to many samples
};

/// Soil drawn from the posterior, with its weight.
struct SoilDraw {
  ContactSoil soil;
  double weight = 0.0;  ///< probability of the draw; the weights of all draws have sum 1
  int soil_class = 0;   ///< index of the soil class in the prior
};

/// Interval that contains the true value of a parameter with 95 % probability.
struct CredibleInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Posterior of the soil parameters: summary and weighted draws.
struct SoilPosterior {
  /// Mean of c, phi, n, k, K (order of soil_mixture.hpp); c1 and c2 of the draw with the largest weight.
  ContactSoil mean;
  SoilMatrix covariance = SoilMatrix::Zero();                     ///< covariance of (c, phi, n, k, K), SI
  double tan_friction = 0.0;                                      ///< mean of tan(phi) [-]
  Eigen::Matrix2d strength_covariance = Eigen::Matrix2d::Zero();  ///< covariance of (c [Pa], tan phi)
  /// Bound of the 95 % ellipse: for x = (c, tan phi), 95 % of the posterior satisfy (x - mean)'
  /// strength_covariance^-1 (x - mean) <= ellipse_95. The bound is 5.99 for a Gaussian posterior, and less if
  /// the bounds of a soil class truncate the posterior.
  double ellipse_95 = 0.0;
  CredibleInterval cohesion_Pa;
  CredibleInterval friction_angle_rad;
  CredibleInterval shear_modulus_m;
  /// Posterior probability of each soil class, in the order of the prior.
  std::vector<double> class_probabilities;
  std::vector<SoilDraw> draws;  ///< weighted soils of the posterior; empty after a stop
  /// Effective number of weighted draws, 1 / (sum of squared weights); below about 20 the results are
  /// inaccurate.
  double effective_draws = 0.0;
  /// Mean square of the whitened residuals in the best soil class [-]; about 1 if model and reading errors
  /// are right.
  double misfit = 0.0;
  std::vector<std::string> unseen;  ///< parameters that the samples hardly constrain, each with the reason
};

}  // namespace talus::terramech
