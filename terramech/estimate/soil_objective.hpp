#pragma once

#include <span>

#include <Eigen/Core>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/soil_fit.hpp>
#include <talus/terramech/estimate/state_population.hpp>
#include <talus/terramech/estimate/truncated_gaussian.hpp>
#include <talus/terramech/estimate/wheel_reading.hpp>

/// The inner workings of soil_posterior.hpp and soil_filter.hpp: the likelihood of samples under one class of
/// soil, in the coordinates y of its prior.
namespace talus::terramech {

/// A sample seen through a soil.
struct SampleMisfit {
  Eigen::Vector2d residual;                              ///< S^-1/2 ((W, T) - f)
  Eigen::Matrix<double, 2, kSoilParameters> derivative;  ///< of -residual, by y
  double cost = 0.0;                                     ///< -log p, up to a constant
  double weight = 1.0;                                   ///< in Gauss-Newton: the slope of the robust loss
};

/// -log likelihood about a point: cost + gradient (y - at) + (y - at)' information (y - at) / 2. All zero: no
/// sample.
struct SoilQuadratic {
  SoilVector at = SoilVector::Zero();
  double cost = 0.0;
  SoilVector gradient = SoilVector::Zero();
  SoilMatrix information = SoilMatrix::Zero();

  double costAt(const SoilVector& y) const;
  SoilVector gradientAt(const SoilVector& y) const { return gradient + information * (y - at); }

  /// The same about another point.
  SoilQuadratic movedTo(const SoilVector& y) const;
};

/// The log-posterior cost of one class of soil given samples.
class SoilObjective {
 public:
  /// What is the same for all classes.
  struct Setting {
    ReadingErrors noise = {};
    double outlier_share = 0.01;
    StatePopulation population = {};  ///< of all samples; none: readings are taken as they are
    ProgressMonitor watch = {};       ///< notified of each pass over many samples; stopping ends passes early
  };

  /// Refers to `soil`, which must outlive it.
  SoilObjective(const SoilClass& soil, const Setting& setting) : soil_(&soil), setting_(setting) {}

  SampleMisfit misfit(const SoilVector& y, const WheelReading& reading) const;

  /// The samples' likelihood to second order (Gauss-Newton) about y, on top of `before`.
  SoilQuadratic expand(const SoilVector& y, std::span<const WheelReading> samples,
                       const SoilQuadratic& before) const;

  /// As expand(), with the slope of the whole cost. Gauss-Newton leaves out that of the normalisation, which
  /// is small for a few samples and adds up over many. Six times the work.
  SoilQuadratic expandWhole(const SoilVector& y, std::span<const WheelReading> samples,
                            const SoilQuadratic& before) const;

  /// -log likelihood of the samples at y, and of `before`.
  double cost(const SoilVector& y, std::span<const WheelReading> samples, const SoilQuadratic& before) const;

  /// Mean square of the whitened residuals; about 1 where soil and noise hold.
  double meanSquare(const SoilVector& y, std::span<const WheelReading> samples) const;

  /// The true (z, i) of a sample given the soil, to first order: the readings moved by what W and T say of
  /// them.
  ContactState likelyState(const ContactSoil& soil, const WheelReading& reading) const;

  /// The same with every sample taken at its word, to find a start from far away: where nothing fits yet, all
  /// samples look like outliers, and the robust loss is flat.
  SoilObjective trusting() const {
    return {*soil_, {setting_.noise, 0.0, setting_.population, setting_.watch}};
  }

  /// The same, its passes over many samples followed and stopped.
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

/// Centre of one class, in standard normal coordinates x (y = Phi(x) where bounded), where the prior needs no
/// bounds.
struct SoilMode {
  SoilVector x = SoilVector::Zero();
  SoilQuadratic likelihood;   ///< about y(x)
  double log_evidence = 0.0;  ///< by Laplace's approximation in x
};

/// Most likely x of samples on top of `before` by damped Gauss-Newton, from `start`.
SoilMode findMode(const SoilObjective& objective, std::span<const WheelReading> samples,
                  const SoilQuadratic& before, const SoilVector& start);

/// findMode() from the middle of the prior and from where the samples lead when all are trusted; the likelier
/// of the two.
SoilMode findModeAfresh(const SoilObjective& objective, std::span<const WheelReading> samples);

/// Samples the posterior of one class: the likelihood's quadratic, cut to the prior's box.
TruncatedGaussian proposal(const SoilClass& soil, const SoilQuadratic& likelihood);

/// A class with its mode, and the information of samples no longer stored.
struct ClassFit {
  SoilObjective objective;
  SoilQuadratic before;
  SoilMode mode;
};

/// Importance samples of every class, weighed against each other, and their summary.
SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws);

/// Throws as fitSoil() does.
void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options);

/// -log of the prior density of a class at y, inside its box.
double priorCost(const SoilClass& soil, const SoilVector& y);

}  // namespace talus::terramech
