#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <talus/terramech/estimate/soil_posterior.hpp>

namespace talus::terramech {

/// Recursive posterior of the soil: one sample at a time, in constant memory (ours).
///
/// The latest samples are stored. Each update finds the mode of every class from its previous value. A sample
/// that leaves the window is replaced by its quadratic about the current mode. Up to `window` samples the
/// result is that of fitSoil(). An update takes about 0.1 ms per class. Not thread-safe; copyable.
class SoilFilter {
 public:
  /// Options of the filter.
  struct Options {
    SoilFitOptions fit;
    std::size_t window = 12;  ///< number of stored samples, >= 1
  };

  /// Throws as fitSoil() for options outside their range, std::invalid_argument for an empty prior, window =
  /// 0 or an invalid wheel.
  SoilFilter(const Wheel& wheel, SoilMixture prior, const Options& options);
  SoilFilter(const SoilFilter& other);
  SoilFilter(SoilFilter&&) noexcept;
  SoilFilter& operator=(SoilFilter other) noexcept;
  ~SoilFilter();

  /// Adds one sample. Throws std::invalid_argument for a sample not of a driven wheel and leaves the filter
  /// unchanged.
  void add(const WheelSample& sample);
  void add(const WheelReading& reading);  ///< sample of another wheel

  /// Returns the current posterior by importance sampling over the window and the removed samples. Slower
  /// than add(). Throws std::domain_error before the first sample.
  SoilPosterior posterior() const;

  /// Return the most likely soil of the most likely class, and the class probabilities, without further
  /// computation.
  ContactSoil mode() const;
  std::vector<double> classProbabilities() const;

  /// Returns the number of samples added.
  std::size_t samples() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus::terramech
