#pragma once

#include <vector>

namespace talus::terramech {

/// A continuously differentiable curve through points that adds no extremum between them: piecewise cubic
/// with the harmonic-mean slopes of Fritsch and Butland (fritsch_butland_1984). Immutable; safe to share
/// between threads.
///
/// Not Boost's pchip (1.74): it needs four points, where a weak soil gives two, and its one-sided slopes at the ends move the
/// slip by up to 0.001 beside the steepest slope that a soil holds. Elsewhere both agree within rounding, in the same time.
class MonotoneCurve {
 public:
  MonotoneCurve() = default;

  /// `x` strictly increasing, as many as `y`, at least two. Throws std::invalid_argument otherwise.
  MonotoneCurve(std::vector<double> x, std::vector<double> y);

  /// Value at x; the end values outside [x.front(), x.back()].
  double at(double x) const noexcept;

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace talus::terramech
