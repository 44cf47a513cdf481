#include <algorithm>
#include <stdexcept>
#include <utility>

#include <talus/terramech/numerics/monotone_curve.hpp>

namespace talus::terramech {
namespace {

/// Derivative at an inner point between intervals of widths w with secant slopes s; 0 at an extremum.
double innerSlope(double w_left, double w_right, double s_left, double s_right) {
  if (s_left * s_right <= 0.0) return 0.0;
  const double a = (2.0 * w_right + w_left), b = (w_right + 2.0 * w_left);
  return (a + b) / (a / s_left + b / s_right);
}

/// Three-point derivative at an end point, limited so that the curve does not overshoot.
double endSlope(double w_near, double w_far, double s_near, double s_far) {
  const double slope = ((2.0 * w_near + w_far) * s_near - w_near * s_far) / (w_near + w_far);
  if (slope * s_near <= 0.0) return 0.0;
  if (s_near * s_far <= 0.0 && std::abs(slope) > 3.0 * std::abs(s_near)) return 3.0 * s_near;
  return slope;
}

}  // namespace

MonotoneCurve::MonotoneCurve(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)) {
  const std::size_t n = x_.size();
  if (n < 2 || y_.size() != n || std::adjacent_find(x_.begin(), x_.end(), std::greater_equal{}) != x_.end())
    throw std::invalid_argument("monotone curve: needs as many y as strictly increasing x, at least 2");
  const auto width = [&](std::size_t k) { return x_[k + 1] - x_[k]; };
  const auto secant = [&](std::size_t k) { return (y_[k + 1] - y_[k]) / width(k); };
  slope_.assign(n, secant(0));
  if (n == 2) return;
  for (std::size_t k = 1; k + 1 < n; ++k)
    slope_[k] = innerSlope(width(k - 1), width(k), secant(k - 1), secant(k));
  slope_[0] = endSlope(width(0), width(1), secant(0), secant(1));
  slope_[n - 1] = endSlope(width(n - 2), width(n - 3), secant(n - 2), secant(n - 3));
}

double MonotoneCurve::at(double x) const noexcept {
  if (!(x > x_.front())) return y_.front();
  if (!(x < x_.back())) return y_.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
  const double w = x_[k + 1] - x_[k], t = (x - x_[k]) / w, u = 1.0 - t;
  return y_[k] * u * u * (1.0 + 2.0 * t) + y_[k + 1] * t * t * (3.0 - 2.0 * t) +
         w * t * u * (slope_[k] * u - slope_[k + 1] * t);
}

}  // namespace talus::terramech
