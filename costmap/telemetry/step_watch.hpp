#pragma once

#include <cstddef>
#include <vector>

namespace talus::costmap {

/// Detects a step between two constants in a number with scatter: the greatest difference of two means over
/// all positions of the step, relative to the scatter on both sides (ours).
class StepWatch {
 public:
  /// `least`: smallest step that is reported, > 0, in the unit of the values.
  explicit StepWatch(double least) : least_(least) {}

  /// Adds a value; a value that is not finite is ignored.
  void add(double value);
  /// Mean after the step minus mean before. 0 (no step) for fewer than three places of kRows values on either
  /// side, for a difference below `least`, and for a difference below kCertain standard errors.
  double step() const noexcept { return step_; }

  static constexpr std::size_t kRows = 10;  ///< consecutive values with a common error, averaged to one place
  static constexpr double kCertain = 6.0;   ///< standard errors

 private:
  void look();

  double least_, step_ = 0.0, sum_ = 0.0;
  std::size_t count_ = 0;
  std::vector<double> places_;
};

}  // namespace talus::costmap
