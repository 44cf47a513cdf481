#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace talus::planner {

/// What is left of a time limit that parts of the work share; the clock starts with the object.
class TimeLeft {
 public:
  explicit TimeLeft(double limit_s) : limit_s_(limit_s) {}

  /// Seconds, < 0 once the limit has passed; infinite without a limit.
  double left_s() const {
    return limit_s_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  /// The part of it for one of so many shares; never 0, which is no time limit.
  double share_s(std::size_t shares = 1) const {
    return std::max(left_s() / static_cast<double>(shares), 1e-9);
  }

 private:
  double limit_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace talus::planner
