#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// Checks whether long work must end: a stop was requested or the time limit passed. Cheap to call; copyable.
class StopCheck {
 public:
  StopCheck() = default;
  StopCheck(const ProgressMonitor& watch)
      : watch_(watch) {}  // NOLINT: a ProgressMonitor alone is a StopCheck without a time limit

  /// Starts the clock with time_limit_s; infinite means no limit.
  StopCheck(const ProgressMonitor& watch, double time_limit_s)
      : watch_(watch), limited_(std::isfinite(time_limit_s)) {
    using std::chrono::duration;
    if (limited_)
      end_ = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(duration<double>(std::min(time_limit_s, 1e8)));
  }

  bool cancelled() const noexcept { return watch_.stopped(); }
  bool timedOut() const noexcept { return limited_ && Clock::now() >= end_; }
  bool operator()() const noexcept { return cancelled() || timedOut(); }

 private:
  using Clock = std::chrono::steady_clock;

  ProgressMonitor watch_;
  bool limited_ = false;
  Clock::time_point end_{};
};

}  // namespace talus::planner
