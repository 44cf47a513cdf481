#pragma once

#include <cstddef>
#include <vector>

namespace talus::costmap {

/// Whether a number that scatters about a constant has stepped to another constant on the way: the greatest difference of two
/// means over all places of the step, against the scatter on both sides of it (ours).
class StepWatch {
 public:
  /// `least`: the smallest step that matters, > 0.
  explicit StepWatch(double least) : least_(least) {}

  /// What is not finite is left out.
  void add(double value);
  /// From where on to the end it differs, less what it was before; 0 where it has not stepped: fewer than three places of
  /// kRows values on either side, less than the least, or less than kCertain standard errors.
  double step() const noexcept { return step_; }

  static constexpr std::size_t kRows = 10;  ///< values of one place, which share their error
  static constexpr double kCertain = 6.0;   ///< standard errors

 private:
  void look();

  double least_, step_ = 0.0, sum_ = 0.0;
  std::size_t count_ = 0;
  std::vector<double> places_;
};

}  // namespace talus::costmap
