#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/soil_fit.hpp>
#include <talus/terramech/estimate/state_population.hpp>
#include <talus/terramech/estimate/truncated_gaussian.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// Likelihood of wheel samples under one soil class, as a function of the coordinates y of the class's prior
/// (Marginal). Part of the implementation of soil_posterior.hpp and soil_filter.hpp, where the symbols are
/// defined.
namespace talus::terramech {

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

  /// Returns the second-order expansion (Gauss-Newton) of -log likelihood of the samples about y, plus
  /// `before`.
  SoilQuadratic expand(const SoilVector& y, std::span<const WheelReading> samples,
                       const SoilQuadratic& before) const;

  /// Returns the expansion of expand(), but with the gradient of the full cost. The Gauss-Newton gradient
  /// neglects the gradient of the normalisation of the likelihood. This term is small for a few samples and
  /// grows with their number. Takes six times as long as expand().
  SoilQuadratic expandWhole(const SoilVector& y, std::span<const WheelReading> samples,
                            const SoilQuadratic& before) const;

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
/// parameter, otherwise y = x. In these coordinates the prior needs no bounds.
struct SoilMode {
  SoilVector x = SoilVector::Zero();  ///< coordinates of the mode
  SoilQuadratic likelihood;           ///< expansion of -log likelihood about y(x)
  double log_evidence = 0.0;          ///< log evidence of the class, by Laplace's approximation in x
};

/// Returns the mode given the samples and `before`, by damped Gauss-Newton steps from `start`.
SoilMode findMode(const SoilObjective& objective, std::span<const WheelReading> samples,
                  const SoilQuadratic& before, const SoilVector& start);

/// Runs findMode() from the centre of the prior, and from the mode that findMode() finds with outlier_share =
/// 0. Returns the result with the higher evidence.
SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples);

/// Returns the importance distribution of one soil class: the Gaussian given by the quadratic of -log
/// likelihood, truncated to the bounds of the prior.
TruncatedGaussian proposal(const SoilClass& soil, const SoilQuadratic& likelihood);

/// Soil class with its mode, and the quadratic of samples that are no longer stored.
struct ClassFit {
  SoilObjective objective;
  SoilQuadratic before;
  SoilMode mode;
};

/// Draws importance samples of every soil class, weights them jointly and returns the posterior. Throws
/// std::domain_error if no draw has a finite weight.
SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws);

/// Throws the exceptions of fitSoil() for invalid samples or options.
void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options);

/// Returns -log of the prior density of a soil class at the coordinates y inside its bounds.
double priorCost(const SoilClass& soil, const SoilVector& y);

}  // namespace talus::terramech
