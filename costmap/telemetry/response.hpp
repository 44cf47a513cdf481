#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

/// One number against another that it should follow: sums of a linear regression.
class Response {
 public:
  /// What is not finite is left out.
  void add(double cause, double effect) noexcept;

  /// What it takes to show that the effect follows.
  struct Claim {
    double least = 0.0;      ///< slope of the regression
    double variation = 0.0;  ///< of the cause, one standard deviation
    double certain = 4.0;    ///< standard errors of the slope
  };
  /// Whether the effect follows the cause: at least 12 pairs, a cause that varies enough, and a slope of the
  /// regression that lies so many of its standard errors above the least.
  bool follows(const Claim& claim) const noexcept;
  /// Slope of the regression and its standard error; of fewer than 12 pairs, or a cause that does not vary, not finite.
  terramech::Estimate slope() const noexcept;
  /// Effect less cause; NaN without any.
  double meanDifference() const noexcept;
  std::size_t size() const noexcept { return count_; }
  double causeVariance() const noexcept;

  static constexpr std::size_t kEnough = 12;

 private:
  std::size_t count_ = 0;
  double cause_ = 0.0, effect_ = 0.0, causes_ = 0.0, effects_ = 0.0, product_ = 0.0;
};

/// The same as it grows: as a whole, and of its last pairs.
class ResponseSeries {
 public:
  void add(double cause, double effect);
  const Response& whole() const noexcept { return whole_; }
  /// Of the last 24 pairs, and of as many before them as it takes until the cause varies by so much.
  Response recent(double variation) const;

 private:
  Response whole_;
  std::deque<std::pair<double, double>> last_;
};

}  // namespace talus::costmap
