#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

#include <talus/common/common.hpp>

namespace talus::planner {

/// Condition that ends a long computation: the caller requested a stop, or the time limit passed. Cheap to
/// call; copyable. The default object never requests an end.
class StopCheck {
 public:
  StopCheck() = default;
  StopCheck(const ProgressMonitor& watch)
      : watch_(watch) {}  // NOLINT: a ProgressMonitor alone is a StopCheck without a time limit

  /// Starts the clock; `time_limit_s` is the time limit from now, infinite for no limit.
  StopCheck(const ProgressMonitor& watch, double time_limit_s)
      : watch_(watch), limited_(std::isfinite(time_limit_s)) {
    using std::chrono::duration;
    if (limited_)
      end_ = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(duration<double>(std::min(time_limit_s, 1e8)));
  }

  /// Returns true if the caller requested a stop.
  bool cancelled() const noexcept { return watch_.stopped(); }
  /// Returns true if the time limit passed.
  bool timedOut() const noexcept { return limited_ && Clock::now() >= end_; }
  /// Returns true if the computation must end.
  bool operator()() const noexcept { return cancelled() || timedOut(); }

 private:
  using Clock = std::chrono::steady_clock;

  ProgressMonitor watch_;
  bool limited_ = false;
  Clock::time_point end_{};
};

/// Remaining time of a time limit that several stages of a computation share. The clock starts at
/// construction.
class TimeLeft {
 public:
  explicit TimeLeft(double limit_s) : limit_s_(limit_s) {}

  /// Returns the remaining time; negative after the limit, infinite without a limit.
  double left_s() const {
    return limit_s_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  /// Returns the remaining time divided by the number of remaining stages, `shares`. The result is always >
  /// 0, because 0 would mean no limit.
  double share_s(std::size_t shares = 1) const {
    return std::max(left_s() / static_cast<double>(shares), 1e-9);
  }

 private:
  double limit_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Timer that adds the time between its construction and its destruction [s] to a sum. The sum must outlive
/// the timer.
class AddedTime {
 public:
  explicit AddedTime(double& sum_s) noexcept : sum_s_(sum_s) {}
  ~AddedTime() { sum_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  AddedTime(const AddedTime&) = delete;
  AddedTime& operator=(const AddedTime&) = delete;

 private:
  double& sum_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace talus::planner
