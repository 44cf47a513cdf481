#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <talus/terramech/estimate/soil_posterior.hpp>

namespace talus::terramech {

/// The soil's posterior as samples come in, one at a time, in constant memory (ours).
///
/// The latest samples are kept as they are, and each update finds every class' mode anew from where it was; a
/// sample that leaves the window is replaced by its quadratic about the mode of that moment. With as many
/// samples as the window holds the result is fitSoil()'s. An update costs about a tenth of a millisecond a
/// class. Not thread-safe; copyable.
class SoilFilter {
 public:
  /// How much is kept and how it is fitted.
  struct Options {
    SoilFitOptions fit;
    std::size_t window = 12;  ///< samples kept as they are, >= 1
  };

  /// Throws as fitSoil() does for a prior or options out of range.
  SoilFilter(const Wheel& wheel, SoilMixture prior, const Options& options);
  SoilFilter(const SoilFilter& other);
  SoilFilter(SoilFilter&&) noexcept;
  SoilFilter& operator=(SoilFilter other) noexcept;
  ~SoilFilter();

  /// Takes one sample in. Throws std::invalid_argument for a sample that is not of a driven wheel; the filter
  /// is unchanged.
  void add(const WheelSample& sample);
  void add(const WheelReading& reading);  ///< on a wheel of its own

  /// What is believed now, in full: importance samples over the window and what went before it. Slower than
  /// add().
  SoilPosterior posterior() const;

  /// The most likely soil of the most likely class and the probabilities of the classes, at no further cost.
  ContactSoil mode() const;
  std::vector<double> classProbabilities() const;

  std::size_t samples() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus::terramech
