#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <boost/math/tools/minima.hpp>

namespace talus::terramech {

/// Closed interval [low, high] of valid values of a field, in the unit of the field.
struct Interval {
  double low;
  double high;
};

/// Checks the fields of one object. Each check throws std::invalid_argument with the message "owner: field =
/// value, must be bound" if the value is not finite or outside its range.
class RangeCheck {
 public:
  /// `owner` names the checked object in messages.
  explicit RangeCheck(std::string owner) : owner_(std::move(owner)) {}

  void finite(const char* field, double value) const;
  void atLeast(const char* field, double value, double bound) const;
  void above(const char* field, double value, double bound) const;
  void within(const char* field, double value, Interval interval) const;
  void zeroOrWithin(const char* field, double value, Interval interval) const;

 private:
  [[noreturn]] void refuse(const char* field, double value, const std::string& bound) const;

  std::string owner_;
};

/// Returns x^2.
constexpr double squared(double x) noexcept {
  return x * x;
}

/// Returns the median of the values. For an even count this is the upper of the two middle values, for an
/// empty vector 0.
inline double medianOf(std::vector<double> v) {
  if (v.empty()) return 0.0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Minimum of a function: abscissa and function value.
struct Minimum {
  double at;
  double value;
};

/// Returns the minimum of f over [low, high], 0 < low < high. The function is first evaluated at `rungs`
/// logarithmically spaced points. Brent's method then refines the best point to 1e-8 of the abscissa.
template <std::invocable<double> F>
Minimum globalMinimum(F&& f, double low, double high, int rungs = 64) {
  const double step = std::log(high / low) / (rungs - 1);
  const auto rung = [&](int i) { return low * std::exp(step * i); };
  Minimum best{low, f(low)};
  int index = 0;
  for (int i = 1; i < rungs; ++i) {
    const double value = f(rung(i));
    if (value < best.value) best = {rung(i), value}, index = i;
  }
  // 26 bits are half of a double's precision; closer to the minimum, a smooth f is constant within rounding.
  const auto [at, value] = boost::math::tools::brent_find_minima(
      std::forward<F>(f), rung(std::max(0, index - 1)), rung(std::min(rungs - 1, index + 1)), 26);
  const Minimum refined{at, value};
  return refined.value < best.value ? refined : best;
}

/// Progress of work in an unknown number of rounds: each round counts as half of the remaining share.
class RoundProgress {
 public:
  /// Returns the share of the work that is done at a share of the present round; a smaller share than before begins
  /// the next round.
  double at(double share) {
    if (share > 0.0 && share < last_) left_ *= 0.5;
    last_ = share > 0.0 ? share : last_;
    return 1.0 - left_ * (1.0 - 0.5 * last_);
  }

 private:
  double left_ = 1.0, last_ = 0.0;
};

/// Natural cubic spline through the points (knots, values), constant beyond the outermost knots. With one
/// knot the spline is constant; without knots it is 0.
class NaturalSpline {
 public:
  NaturalSpline() = default;
  NaturalSpline(std::vector<double> knots, std::vector<double> values);

  /// Returns the value of the spline at x.
  double operator()(double x) const;

 private:
  std::vector<double> knots_, values_, curvatures_;
};

/// Return the density and the cumulative distribution function of the standard normal distribution at x.
double normalDensity(double x);
double normalProbability(double x);

/// Returns x with normalProbability(x) = p, with an error of about 1e-12. Throws std::invalid_argument unless
/// 0 < p < 1.
double normalQuantile(double p);

}  // namespace talus::terramech
