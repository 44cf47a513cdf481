#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// MotionCost with a count of its work, so that a planner ends after the same work on every machine. The
/// latest result is kept, because OMPL requests the cost of a motion and then its validity. Every point
/// except start and goal may become a turn. Therefore a motion is allowed only if a route may turn at both
/// ends of the motion (MotionCost::turnAllowed()); otherwise the route check would reject routes composed of
/// such motions. Use one object per planning run; not thread-safe.
class MeteredCost {
 public:
  /// `ends` are start and goal of the problem.
  MeteredCost(std::shared_ptr<const costmap::CostGrid> map, const Segment& ends)
      : motion_(std::move(map)), ends_(ends) {}

  const MotionCost& motion() const noexcept { return motion_; }

  /// Returns the exact cost of a motion [J]; infinite if the motion is not allowed.
  double operator()(const Segment& motion) const noexcept;

  /// Adds the work of one iteration of a planner: 100 cell lengths.
  void iterated() const noexcept { work_ += 100; }

  /// Returns the work so far [evaluated cell lengths].
  std::uint64_t work() const noexcept { return work_; }

 private:
  bool turnsAllowed(const Segment& motion) const noexcept;

  MotionCost motion_;
  Segment ends_;                                  // start and goal
  mutable Segment last_{{NAN, NAN}, {NAN, NAN}};  // latest motion; initially equal to no motion
  mutable double last_cost_J_ = 0.0;
  mutable std::uint64_t work_ = 0;
};

}  // namespace talus::planner
