#pragma once

#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/numerics/estimate.hpp>

/// Distribution of the true loads and slips of a drive, estimated from the readings (ours: empirical Bayes).
/// A reading far from all others probably has a large error. Without the distribution, the scatter of the
/// errors would count as scatter of the true values and bias the estimate, independent of the number of rows.
namespace talus::terramech {

/// Gaussian distribution of the true ln W and of the true slip, updated by one reading at a time in constant
/// memory. With three readings or fewer, readings are returned unchanged.
class StatePopulation {
 public:
  void add(const WheelSample& sample, const ReadingErrors& errors);

  /// Returns the load [N] or slip [-] combined with the population: x* = mean + s (x - mean), s = V/(V +
  /// std^2), standard deviation sqrt(s) std, with x = ln W or x = slip. The slip is clamped to [0, 1].
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
