#pragma once

#include <vector>

namespace talus::terramech {

/// Continuously differentiable interpolation that preserves monotonicity: piecewise cubic with the
/// harmonic-mean slopes of Fritsch and Butland (fritsch_butland_1984), without extrema between the points.
/// Immutable; safe to share between threads.
///
/// Boost's pchip (1.74) is not used. Boost's function needs four points, while the mobility curve of a weak
/// soil has only two, and its one-sided end slopes change the slip by up to 0.001 close to the maximum
/// climbable slope. Elsewhere the results agree within rounding.
class MonotoneCurve {
 public:
  MonotoneCurve() = default;

  /// Interpolates y over x. Throws std::invalid_argument if x is not strictly increasing, if the sizes
  /// differ, or if there are fewer than two points.
  MonotoneCurve(std::vector<double> x, std::vector<double> y);

  /// Returns the interpolated value at x. Outside [x.front(), x.back()] the value is that of the nearer end.
  double at(double x) const noexcept;

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace talus::terramech
