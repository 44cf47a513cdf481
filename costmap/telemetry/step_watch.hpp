#pragma once

#include <cstddef>
#include <vector>

namespace talus::costmap {

/// Detects a step between two constants in a noisy number, e.g. in the slip on level ground. The step is the
/// greatest difference of two means over all positions of the step, relative to the scatter on both sides
/// (ours).
class StepWatch {
 public:
  /// Makes the detector; `least` > 0 is the smallest step that is reported, in the unit of the values.
  explicit StepWatch(double least) : least_(least) {}

  /// Adds a value; a value that is not finite is ignored.
  void add(double value);
  /// Returns the mean after the step minus the mean before it. Returns 0 (no step) for fewer than three
  /// groups of kRows values on either side, for a difference below `least`, and for a difference below
  /// kCertain standard errors.
  double step() const noexcept { return step_; }

  /// Number of consecutive values, which may share an error, that are averaged to one group.
  static constexpr std::size_t kRows = 10;
  static constexpr double kCertain = 6.0;  ///< least difference [standard errors]

 private:
  void look();

  double least_, step_ = 0.0, sum_ = 0.0;
  std::size_t count_ = 0;
  std::vector<double> places_;
};

}  // namespace talus::costmap
