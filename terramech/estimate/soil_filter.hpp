#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <talus/terramech/estimate/soil_posterior.hpp>

namespace talus::terramech {

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

  /// Return the most likely soil of the most probable soil class, and the probabilities of the classes,
  /// without further computation.
  ContactSoil mode() const;
  std::vector<double> classProbabilities() const;

  /// Returns the number of samples added.
  std::size_t samples() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus::terramech
