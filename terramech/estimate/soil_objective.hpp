#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Box in the coordinates of the soil parameters. Infinite bounds are allowed.
struct SoilBox {
  SoilVector low;
  SoilVector high;
};

/// Gaussian distribution truncated to a box, with the sampler of Geweke, Hajivassiliou and Keane
/// (geweke_1991). Each coordinate is drawn inside its bounds given the coordinates drawn before it, so that
/// no draw is rejected and the density of a draw is known. The coordinate with the largest conditional
/// variance is drawn first (pivoted Cholesky factor), because the box truncates this coordinate most.
class TruncatedGaussian {
 public:
  /// Mean and covariance are those of the Gaussian before truncation. Requires a positive definite
  /// `covariance` and a `box` with low < high.
  TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box);

  /// Drawn point, and the logarithm of the density with which the point was drawn.
  struct Draw {
    SoilVector at;
    double log_density;
  };

  /// Returns the draw that corresponds to a point `even` of the unit cube, for example a point of
  /// evenPoints().
  Draw draw(const SoilVector& even) const;

 private:
  SoilVector mean_;
  SoilBox box_;
  std::array<int, kSoilParameters> order_;
  // The rows of the root are coordinates, its columns follow the order of drawing; covariance = root root'.
  SoilMatrix root_ = SoilMatrix::Zero();
};

/// Distribution of the true loads and slips of a drive, estimated from the readings (ours: empirical Bayes).
/// A reading far from all others probably has a large error. Without this distribution, the scatter of the
/// reading errors would count as scatter of the true values and would bias the estimate of the soil, for any
/// number of rows.

/// Gaussian distribution of the true ln W (W = load) and of the true slip over the samples of a drive. The
/// distribution is updated by one sample at a time in constant memory. With three samples or fewer, readings
/// are returned unchanged.
class StatePopulation {
 public:
  /// Adds one sample with the errors of its readings.
  void add(const WheelSample& sample, const ReadingErrors& errors);

  /// Return the load [N] or slip [-] of a sample, combined with the distribution. For a reading x (ln W or
  /// slip) with standard deviation std, and a distribution with variance V, the result is mean + s (x - mean)
  /// with s = V/(V + std^2) and the standard deviation sqrt(s) std. The slip is clamped to [0, 1].
  Estimate load(const WheelSample& sample, const ReadingErrors& errors) const;
  Estimate slip(const WheelSample& sample, const ReadingErrors& errors) const;

 private:
  struct Spread {
    void add(const Estimate& reading);
    Estimate combine(const Estimate& reading) const;

    PairMoments readings;
    double error_variance = 0.0;
  };

  Spread log_load_, slip_;
};

/// Likelihood of wheel samples under one soil class, as a function of the coordinates y of the class's prior
/// (Marginal). Part of the implementation of soil_estimation.hpp and soil_estimation.hpp, where the symbols are
/// defined.

/// Misfit of one sample (W, T) to the prediction f of a soil, with the covariance S of the residual.
struct SampleMisfit {
  Eigen::Vector2d residual;                              ///< whitened residual S^-1/2 ((W, T) - f)
  Eigen::Matrix<double, 2, kSoilParameters> derivative;  ///< derivative of -residual with respect to y
  double cost = 0.0;                                     ///< -log likelihood, up to a constant
  double weight = 1.0;  ///< derivative of the robust loss: weight of the sample in Gauss-Newton
};

/// Quadratic expansion of -log likelihood about a point `at`: cost + gradient (y - at) + (y - at)'
/// information (y - at) / 2. Without samples all terms are 0.
struct SoilQuadratic {
  SoilVector at = SoilVector::Zero();
  double cost = 0.0;
  SoilVector gradient = SoilVector::Zero();
  SoilMatrix information = SoilMatrix::Zero();

  /// Return the value and the gradient of the quadratic at y.
  double costAt(const SoilVector& y) const;
  SoilVector gradientAt(const SoilVector& y) const { return gradient + information * (y - at); }

  /// Returns the same quadratic, expanded about y.
  SoilQuadratic movedTo(const SoilVector& y) const;
};

/// -log likelihood of samples as a function of the soil of one class. Arguments named `before` contain the
/// quadratic of samples that are no longer stored.
class SoilObjective {
 public:
  /// Settings common to all soil classes.
  struct Setting {
    ReadingErrors noise = {};     ///< standard deviations of the readings
    double outlier_share = 0.01;  ///< expected fraction of outliers, [0, 0.5]
    /// Distribution of load and slip over all samples; empty: readings are used unchanged.
    StatePopulation population = {};
    /// Receives the progress of each pass over many samples; a stop ends a pass early.
    ProgressMonitor watch = {};
  };

  /// Stores a reference to `soil`, which must outlive the object.
  SoilObjective(const SoilClass& soil, const Setting& setting) : soil_(&soil), setting_(setting) {}

  /// Returns the misfit of one sample at the soil with coordinates y.
  SampleMisfit misfit(const SoilVector& y, const WheelReading& reading) const;

  /// Gradient of expand(). Gauss-Newton neglects the gradient of the normalisation of the likelihood. This term is
  /// small for a few samples and grows with their number; the whole gradient takes six times as long.
  enum class Gradient { GaussNewton, Whole };

  /// Returns the second-order expansion of -log likelihood of the samples about y, plus `before`.
  SoilQuadratic expand(const SoilVector& y, std::span<const WheelReading> samples,
                       const SoilQuadratic& before, Gradient gradient) const;

  /// Returns -log likelihood of the samples at y, plus the value of `before`.
  double cost(const SoilVector& y, std::span<const WheelReading> samples, const SoilQuadratic& before) const;

  /// Returns the mean square of the whitened residuals [-]; about 1 if soil and reading errors are right.
  double meanSquare(const SoilVector& y, std::span<const WheelReading> samples) const;

  /// Returns the most likely sinkage and slip (z, i) of a sample given the soil, to first order: the readings
  /// of z and i are corrected by the readings of W and T.
  ContactState likelyState(const ContactSoil& soil, const WheelReading& reading) const;

  /// Returns the objective with outlier_share = 0, for the search of an initial value. Far from the mode
  /// (most likely soil) the residual of every sample is that of an outlier, and the robust loss is flat.
  SoilObjective trusting() const {
    return {*soil_, {setting_.noise, 0.0, setting_.population, setting_.watch}};
  }

  /// Returns a copy of the objective whose passes over many samples report progress and can be cancelled.
  SoilObjective watchedBy(const ProgressMonitor& watch) const {
    SoilObjective watched = *this;
    watched.setting_.watch = watch;
    return watched;
  }

  const SoilClass& soilClass() const { return *soil_; }

 private:
  const SoilClass* soil_;
  Setting setting_;
};

/// Mode (most likely soil) of one soil class, in standard normal coordinates x: y = Phi(x) for a bounded
/// parameter, otherwise y = x. In these coordinates the prior is the standard normal distribution without bounds.
struct SoilMode {
  SoilVector x = SoilVector::Zero();  ///< coordinates of the mode
  SoilQuadratic likelihood;           ///< expansion of -log likelihood about y(x)
  double log_evidence = 0.0;          ///< log evidence of the class, by Laplace's approximation in x
};

/// Returns the mode given the samples and `before`, by damped Newton steps from `start`.
SoilMode findMode(const SoilObjective& objective, std::span<const WheelReading> samples,
                  const SoilQuadratic& before, const SoilVector& start, SoilObjective::Gradient gradient);

/// Runs findMode() from the centre of the prior, and from the mode that findMode() finds with outlier_share =
/// 0. Returns the result with the higher evidence.
SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples,
                        SoilObjective::Gradient gradient);

/// Returns the importance distribution of one soil class: the Gaussian given by the quadratic of -log
/// likelihood, truncated to the bounds of the prior.
TruncatedGaussian proposal(const SoilClass& soil, const SoilQuadratic& likelihood);

/// Soil class with its mode, and the quadratic of samples that are not weighted with each draw.
struct ClassFit {
  SoilObjective objective;
  SoilQuadratic before;
  SoilMode mode;
};

/// Draws importance samples of every soil class, weights them jointly and returns the posterior without its misfit.
/// Throws std::domain_error if no draw has a finite weight.
SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws);

/// Throws the exceptions of fitSoil() for invalid samples or options.
void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options);

/// Searches the mode of every soil class on 512 evenly spread samples, then on 16 times as many, and so on, in the
/// classes that are not yet excluded. For more than 300 samples the likelihood of all samples is replaced by a quadratic
/// approximation about the mode, so that a draw is not weighted with every sample. The time is about 50 us
/// per sample; the memory does not depend on the number of samples. Returns no classes after a stop by the watch.
std::vector<ClassFit> fitClasses(const std::vector<SoilObjective>& classes,
                                 std::span<const WheelReading> samples, const ProgressMonitor& watch);

/// Returns -log of the prior density of a soil class at the coordinates y inside its bounds.
double priorCost(const SoilClass& soil, const SoilVector& y);

/// Returns the samples with which each draw is weighted: all of up to 300 samples, otherwise none.
std::span<const WheelReading> weighted(std::span<const WheelReading> samples);

/// Returns `count` samples that are spread evenly over all samples, in their order. Returns all samples if
/// there are at most `count`.
std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count);

}  // namespace talus::terramech
