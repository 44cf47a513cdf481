#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

/// Linear regression of one number (effect) on another (cause), computed from sums.
class Response {
 public:
  /// Adds a pair of numbers; a pair with a number that is not finite is ignored.
  void add(double cause, double effect) noexcept;

  /// Conditions for follows().
  struct Claim {
    double least = 0.0;      ///< least regression slope
    double variation = 0.0;  ///< least standard deviation of the cause
    double certain = 4.0;    ///< number of standard errors by which the regression slope must exceed `least`
  };
  /// Returns true if the effect follows the cause: there are at least 12 pairs, the standard deviation of the
  /// cause is at least `variation`, and the regression slope exceeds `least` by at least `certain` standard
  /// errors.
  bool follows(const Claim& claim) const noexcept;
  /// Returns the regression slope with its standard error; not finite for fewer than 12 pairs or a constant
  /// cause.
  terramech::Estimate slope() const noexcept;
  /// Returns the mean of effect minus cause; NaN without pairs.
  double meanDifference() const noexcept;
  std::size_t size() const noexcept { return count_; }
  double causeVariance() const noexcept;

  /// Least number of pairs of a regression.
  static constexpr std::size_t kEnough = 12;

 private:
  std::size_t count_ = 0;
  double cause_ = 0.0, effect_ = 0.0, causes_ = 0.0, effects_ = 0.0, product_ = 0.0;
};

/// Regressions of a growing series of pairs: over all pairs, and over the most recent pairs.
class ResponseSeries {
 public:
  void add(double cause, double effect);
  const Response& whole() const noexcept { return whole_; }
  /// Returns the regression of the last 24 pairs, extended by earlier pairs until the standard deviation of
  /// the cause reaches `variation`, and by at most 240 pairs in total.
  Response recent(double variation) const;

 private:
  Response whole_;
  std::deque<std::pair<double, double>> last_;
};

}  // namespace talus::costmap
