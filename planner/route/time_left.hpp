#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace talus::planner {

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

}  // namespace talus::planner
