#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Standard deviation of a sensor reading, as a relative and an absolute component that add in quadrature.
struct ReadingError {
  double relative = 0.0;  ///< component proportional to the reading [-]
  double absolute = 0.0;  ///< constant component, in the unit of the reading

  /// Returns the standard deviation of a reading with this value, in the unit of the reading.
  double std(double value) const { return std::hypot(relative * value, absolute); }
};

/// Errors of the four readings of a wheel. The default is 5 % of each reading, as in the simulations of the
/// thesis.
struct ReadingErrors {
  ReadingError load{.relative = 0.05};
  ReadingError torque{.relative = 0.05};
  ReadingError sinkage{.relative = 0.05};
  ReadingError slip{.relative = 0.05};

  /// Returns errors with the same relative standard deviation `share` [-] for all four readings.
  static ReadingErrors relative(double share) { return {{share}, {share}, {share}, {share}}; }
};

/// Telemetry sample with its wheel, for tables with several wheel sizes.
struct WheelReading {
  Wheel wheel;
  WheelSample sample;  ///< readings of this wheel
};

/// Standard deviation of each field of Soil, in the unit of the field; 0: exactly known.
struct SoilDeviation {
  double cohesion_Pa = 0.0;
  double friction_angle_rad = 0.0;
  double sinkage_exponent = 0.0;
  double cohesive_modulus = 0.0;
  double frictional_modulus = 0.0;
  double shear_modulus_m = 0.0;
  double c1 = 0.0;
  double c2 = 0.0;
  double density_kg_m3 = 0.0;
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double rut_stiffness = 0.0;
};

/// Prior of a soil: independent Gaussians of all parameters.
struct SoilPrior {
  Soil mean;
  SoilDeviation deviation;
};

/// Prior of a soil as a mixture of soil classes (sand, clay, ...).

/// Number of soil parameters that are estimated: cohesion c, friction angle phi, sinkage exponent n, sinkage
/// modulus k, shear modulus K. Their order is that of the first columns of ContactDerivative.
inline constexpr int kSoilParameters = 5;
using SoilVector = Eigen::Matrix<double, kSoilParameters, 1>;
using SoilMatrix = Eigen::Matrix<double, kSoilParameters, kSoilParameters>;

/// Prior of one soil parameter. The parameter is a function of a coordinate y that is uniform on [0, 1]
/// (bounded prior) or standard normal.
class Marginal {
 public:
  Marginal() = default;  ///< parameter fixed at 0

  /// Returns the prior of an exactly known parameter.
  static Marginal fixed(double value);

  /// Returns a uniform prior between two bounds: value = low + (high - low) y. Throws std::invalid_argument
  /// unless low < high.
  static Marginal uniform(double low, double high);

  /// Returns a log-uniform prior between two bounds. Throws std::invalid_argument unless 0 < low < high.
  static Marginal logUniform(double low, double high);

  /// Returns a Gaussian prior; a value below `least` is replaced by `least`. Throws std::invalid_argument
  /// unless std > 0.
  static Marginal normal(double mean, double std, double least);

  /// Returns the value of the parameter at the coordinate y.
  double at(double y) const;
  double slope(double y) const;  ///< returns d at(y) / dy
  /// Returns true if y is uniform on [0, 1], false if y is standard normal.
  bool bounded() const { return shape_ != Shape::Normal; }

 private:
  enum class Shape { Uniform, LogUniform, Normal };

  Shape shape_ = Shape::Uniform;
  double low_ = 0.0;  // smallest value `least` if the shape is Normal
  double high_ = 0.0;
  double mean_ = 0.0;
  double std_ = 0.0;
};

/// Soil class: independent priors of the five soil parameters.
struct SoilClass {
  std::string name;
  double probability = 1.0;  ///< prior probability of the class; the classes of a mixture should have sum 1
  /// Priors of c [Pa], phi [rad], n, k [N/m^(n+2)], K [m].
  std::array<Marginal, kSoilParameters> parameters{};
  double c1 = 0.43;  ///< ratio theta_m / theta_1 of stress-peak angle to entry angle at slip 0 [-]
  double c2 = 0.32;  ///< increase of theta_m / theta_1 per unit slip [-]

  /// Return the soil at the coordinates y of its parameters, and the derivative of each parameter with
  /// respect to its coordinate.
  ContactSoil at(const SoilVector& y) const;
  SoilVector slope(const SoilVector& y) const;
};

/// Prior of a soil as a mixture of soil classes.
using SoilMixture = std::vector<SoilClass>;

/// Returns the classes sand, clay, loam and firm soil with the ranges of thesis Table 2.1, each with
/// probability 0.25.
SoilMixture thesisSoils();

/// Returns thesisSoils() plus a class "other" with the given probability in [0, 1), which covers natural and
/// simulant soils: c 0 to 20 kPa, phi 15 to 50 deg, n 0.3 to 1.8, k 1e4 to 1e8, K 3 to 60 mm (ranges ours,
/// around thesis Tables 2.3 and A.1).
SoilMixture thesisSoilsOrOther(double other_probability = 0.02);

/// Options and result of the Bayesian soil fit.

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
  /// Mean of c, phi, n, k, K (order of SoilVector); c1 and c2 of the draw with the largest weight.
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

/// Recursive estimate of the soil: the posterior is updated by one sample at a time, in constant memory
/// (ours).
///
/// The filter stores the latest `window` samples. Each update searches the mode (most likely soil) of every
/// soil class from its previous value. When a sample leaves the window, its log-likelihood is replaced by a
/// quadratic about the current mode. Up to `window` samples the result is that of fitSoil(). An update takes
/// about 0.1 ms per class. Not thread-safe; copyable.
class SoilFilter {
 public:
  /// Options of the filter.
  struct Options {
    SoilFitOptions fit;
    std::size_t window = 12;  ///< number of stored samples, >= 1
  };

  /// Throws the exceptions of fitSoil() for fit options outside their range, and std::invalid_argument for an
  /// empty prior, window = 0 or an invalid wheel.
  SoilFilter(const Wheel& wheel, SoilMixture prior, const Options& options);
  SoilFilter(const SoilFilter& other);
  SoilFilter(SoilFilter&&) noexcept;
  SoilFilter& operator=(SoilFilter other) noexcept;
  ~SoilFilter();

  /// Adds one sample. Throws std::invalid_argument for a sample that is not of a driven wheel, and then
  /// leaves the filter unchanged.
  void add(const WheelSample& sample);
  void add(const WheelReading& reading);  ///< adds a sample of another wheel

  /// Returns the current posterior, by importance sampling over the stored samples and the quadratics of
  /// removed samples. Takes longer than add(). Throws std::domain_error before the first sample.
  SoilPosterior posterior() const;

  /// Returns the number of samples added.
  std::size_t samples() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus::terramech
