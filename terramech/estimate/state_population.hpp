#pragma once

#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/numerics/estimate.hpp>

/// Distribution of the true loads and slips of a drive, estimated from the readings (ours: empirical Bayes).
/// A reading far from all others probably has a large error. Without this distribution, the scatter of the
/// reading errors would count as scatter of the true values and would bias the estimate of the soil, for any
/// number of rows.
namespace talus::terramech {

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

    double count = 0.0, mean = 0.0, squares = 0.0, error_variance = 0.0;
  };

  Spread log_load_, slip_;
};

}  // namespace talus::terramech
