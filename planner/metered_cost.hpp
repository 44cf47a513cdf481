#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <planner/motion_cost.hpp>

namespace talus::planner {

/// MotionCost that counts its work, so that a planner can be stopped after the same work on every machine,
/// and that remembers its last answer, since OMPL asks for the cost of a motion and then whether it is valid.
/// One object a planning run: not thread-safe.
class MeteredCost {
 public:
  explicit MeteredCost(std::shared_ptr<const costmap::CostGrid> map) : motion_(std::move(map)) {}

  const MotionCost& motion() const noexcept { return motion_; }

  /// Exact cost in joules, infinite when the motion is not allowed.
  double operator()(const Segment& motion) const noexcept;

  /// Counts one iteration of a planner, as dear as a hundred cells.
  void iterated() const noexcept { work_ += 100; }

  /// Work done so far, in cells' lengths evaluated [-].
  std::uint64_t work() const noexcept { return work_; }

 private:
  MotionCost motion_;
  mutable Segment last_{{NAN, NAN}, {NAN, NAN}};  // equal to no motion
  mutable double last_cost_J_ = 0.0;
  mutable std::uint64_t work_ = 0;
};

}  // namespace talus::planner
