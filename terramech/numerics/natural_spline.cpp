#include <cstddef>
#include <span>
#include <utility>

#include <talus/terramech/numerics/natural_spline.hpp>

namespace talus::terramech {
namespace {

/// Second derivatives at the knots of the natural cubic spline (tridiagonal system, Thomas algorithm).
std::vector<double> curvatures(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  std::vector<double> m(n, 0.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = x[i] - x[i - 1], b = x[i + 1] - x[i];
    const double pivot = 2.0 * (a + b) - a * upper[i - 1];
    upper[i] = b / pivot;
    m[i] = (6.0 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a) - a * m[i - 1]) / pivot;
  }
  for (std::size_t i = n; i-- > 2;) m[i - 1] -= upper[i - 1] * m[i];
  return m;
}

}  // namespace

NaturalSpline::NaturalSpline(std::vector<double> knots, std::vector<double> values)
    : knots_(std::move(knots)), values_(std::move(values)), curvatures_(curvatures(knots_, values_)) {}

double NaturalSpline::operator()(double x) const {
  const std::size_t n = knots_.size();
  if (n == 0) return 0.0;
  if (n == 1 || x <= knots_.front()) return values_.front();
  if (x >= knots_.back()) return values_.back();
  std::size_t i = 0;
  while (x > knots_[i + 1]) ++i;
  const double h = knots_[i + 1] - knots_[i], b = (x - knots_[i]) / h, a = 1.0 - b;
  return a * values_[i] + b * values_[i + 1] +
         ((a * a * a - a) * curvatures_[i] + (b * b * b - b) * curvatures_[i + 1]) * h * h / 6.0;
}

}  // namespace talus::terramech
