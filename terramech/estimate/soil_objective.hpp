#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/soil_fit.hpp>
#include <talus/terramech/estimate/state_population.hpp>
#include <talus/terramech/estimate/truncated_gaussian.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// Likelihood of samples under one soil class, in the coordinates y of its prior. Implementation of
/// soil_posterior.hpp and soil_filter.hpp.
namespace talus::terramech {

/// Misfit of one sample under a soil.
struct SampleMisfit {
  Eigen::Vector2d residual;                              ///< S^-1/2 ((W, T) - f)
  Eigen::Matrix<double, 2, kSoilParameters> derivative;  ///< of -residual by y
  double cost = 0.0;                                     ///< -log p, up to a constant
  double weight = 1.0;  ///< derivative of the robust loss, the weight in Gauss-Newton
};

/// Quadratic expansion of -log likelihood about a point `at`: cost + gradient (y - at) + (y - at)'
/// information (y - at) / 2. Without samples all terms are 0.
struct SoilQuadratic {
  SoilVector at = SoilVector::Zero();
  double cost = 0.0;
  SoilVector gradient = SoilVector::Zero();
  SoilMatrix information = SoilMatrix::Zero();

  double costAt(const SoilVector& y) const;
  SoilVector gradientAt(const SoilVector& y) const { return gradient + information * (y - at); }

  /// Returns the same quadratic expanded about another point.
  SoilQuadratic movedTo(const SoilVector& y) const;
};

/// -log posterior of one soil class given samples.
class SoilObjective {
 public:
  /// Settings common to all classes.
  struct Setting {
    ReadingErrors noise = {};
    double outlier_share = 0.01;
    StatePopulation population = {};  ///< population of all samples; empty: readings are used unchanged
    ProgressMonitor watch = {};       ///< progress of each pass over many samples; a stop ends a pass early
  };

  /// Stores a reference to `soil`, which must outlive the object.
  SoilObjective(const SoilClass& soil, const Setting& setting) : soil_(&soil), setting_(setting) {}

  SampleMisfit misfit(const SoilVector& y, const WheelReading& reading) const;

  /// Returns the second-order expansion (Gauss-Newton) of the samples' likelihood about y, added to `before`.
  SoilQuadratic expand(const SoilVector& y, std::span<const WheelReading> samples,
                       const SoilQuadratic& before) const;

  /// Returns the expansion of expand() with the gradient of the full cost. The Gauss-Newton gradient neglects
  /// the gradient of the normalisation, which is small for a few samples and grows with their number. Takes
  /// six times as long as expand().
  SoilQuadratic expandWhole(const SoilVector& y, std::span<const WheelReading> samples,
                            const SoilQuadratic& before) const;

  /// Returns -log likelihood of the samples at y, plus `before`.
  double cost(const SoilVector& y, std::span<const WheelReading> samples, const SoilQuadratic& before) const;

  /// Returns the mean square of the whitened residuals; about 1 if soil and noise are right.
  double meanSquare(const SoilVector& y, std::span<const WheelReading> samples) const;

  /// Returns the most likely (z, i) of a sample given the soil, to first order: the readings of z and i
  /// corrected by those of W and T.
  ContactState likelyState(const ContactSoil& soil, const WheelReading& reading) const;

  /// Returns the objective with outlier_share = 0, for the search of an initial value: far from the mode the
  /// residual of every sample is that of an outlier, and the robust loss is flat.
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

/// Mode of one class in standard normal coordinates x (y = Phi(x) if bounded), in which the prior needs no
/// bounds.
struct SoilMode {
  SoilVector x = SoilVector::Zero();
  SoilQuadratic likelihood;   ///< expanded about y(x)
  double log_evidence = 0.0;  ///< Laplace approximation in x
};

/// Returns the most likely x of the samples and `before` by damped Gauss-Newton from `start`.
SoilMode findMode(const SoilObjective& objective, std::span<const WheelReading> samples,
                  const SoilQuadratic& before, const SoilVector& start);

/// Runs findMode() from the centre of the prior, and from the mode without outliers; returns the result with
/// the higher evidence.
SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples);

/// Returns the importance distribution of one class: the quadratic of the likelihood, truncated to the box of
/// the prior.
TruncatedGaussian proposal(const SoilClass& soil, const SoilQuadratic& likelihood);

/// Class with its mode, and the information of samples no longer stored.
struct ClassFit {
  SoilObjective objective;
  SoilQuadratic before;
  SoilMode mode;
};

/// Draws importance samples of every class, weights them jointly and returns their summary. Throws
/// std::domain_error if no draw has a finite weight.
SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws);

/// Throws as fitSoil() does.
void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options);

/// Returns -log of the prior density of a class at y inside its box.
double priorCost(const SoilClass& soil, const SoilVector& y);

}  // namespace talus::terramech
