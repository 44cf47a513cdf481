#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

/// Linear regression of one number (effect) on another (cause), from sums.
class Response {
 public:
  /// Adds a pair; a pair with a number that is not finite is ignored.
  void add(double cause, double effect) noexcept;

  /// Conditions for follows().
  struct Claim {
    double least = 0.0;      ///< least slope of the regression
    double variation = 0.0;  ///< least standard deviation of the cause
    double certain = 4.0;    ///< number of standard errors of the slope
  };
  /// True if the effect follows the cause: at least 12 pairs, a standard deviation of the cause of at least
  /// `variation`, and a slope of the regression at least `certain` standard errors above `least`.
  bool follows(const Claim& claim) const noexcept;
  /// Slope of the regression and its standard error; not finite for fewer than 12 pairs or a constant cause.
  terramech::Estimate slope() const noexcept;
  /// Mean of effect minus cause; NaN without pairs.
  double meanDifference() const noexcept;
  std::size_t size() const noexcept { return count_; }
  double causeVariance() const noexcept;

  static constexpr std::size_t kEnough = 12;

 private:
  std::size_t count_ = 0;
  double cause_ = 0.0, effect_ = 0.0, causes_ = 0.0, effects_ = 0.0, product_ = 0.0;
};

/// Regressions of a growing series of pairs: over all pairs, and over the last pairs.
class ResponseSeries {
 public:
  void add(double cause, double effect);
  const Response& whole() const noexcept { return whole_; }
  /// Regression of the last 24 pairs, and of earlier pairs until the standard deviation of the cause reaches
  /// `variation`; at most 240 pairs.
  Response recent(double variation) const;

 private:
  Response whole_;
  std::deque<std::pair<double, double>> last_;
};

}  // namespace talus::costmap
