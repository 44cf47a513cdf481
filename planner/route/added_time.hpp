#pragma once

#include <chrono>

namespace talus::planner {

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
