#pragma once

#include <vector>

namespace talus::terramech {

/// Continuously differentiable, shape-preserving interpolation: piecewise cubic with the harmonic-mean slopes
/// of Fritsch and Butland (fritsch_butland_1984), without extrema between the points. Immutable; safe to
/// share between threads.
///
/// Boost's pchip (1.74) is not used: pchip needs four points, while the curve of a weak soil has only two,
/// and the one-sided end slopes of pchip change the slip by up to 0.001 close to the maximum climbable slope.
/// Elsewhere the results agree within rounding.
class MonotoneCurve {
 public:
  MonotoneCurve() = default;

  /// Interpolates y over strictly increasing x. Throws std::invalid_argument if x is not strictly increasing,
  /// the sizes differ or there are fewer than two points.
  MonotoneCurve(std::vector<double> x, std::vector<double> y);

  /// Returns the value at x; outside [x.front(), x.back()] the value of the nearer end.
  double at(double x) const noexcept;

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace talus::terramech
