#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include <talus/common/progress_monitor.hpp>

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

}  // namespace talus::planner
