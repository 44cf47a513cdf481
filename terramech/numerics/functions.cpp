#include <array>
#include <numbers>
#include <span>
#include <sstream>
#include <stdexcept>

#include <boost/math/special_functions/erf.hpp>

#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

void RangeCheck::finite(const char* field, double value) const {
  if (!std::isfinite(value)) refuse(field, value, "finite");
}

void RangeCheck::atLeast(const char* field, double value, double bound) const {
  finite(field, value);
  if (value < bound) refuse(field, value, ">= " + text(bound));
}

void RangeCheck::above(const char* field, double value, double bound) const {
  finite(field, value);
  if (value <= bound) refuse(field, value, "> " + text(bound));
}

void RangeCheck::within(const char* field, double value, Interval interval) const {
  finite(field, value);
  if (value < interval.low || value > interval.high)
    refuse(field, value, "in [" + text(interval.low) + ", " + text(interval.high) + "]");
}

void RangeCheck::zeroOrWithin(const char* field, double value, Interval interval) const {
  finite(field, value);
  if (value != 0.0 && (value < interval.low || value > interval.high))
    refuse(field, value, "0 or in [" + text(interval.low) + ", " + text(interval.high) + "]");
}

void RangeCheck::refuse(const char* field, double value, const std::string& bound) const {
  throw std::invalid_argument(owner_ + ": " + field + " = " + text(value) + ", must be " + bound);
}

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

double normalDensity(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

double normalProbability(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normalQuantile(double p) {
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("normal quantile: probability must be in (0, 1)");
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * p, InDouble());
}

}  // namespace talus::terramech
