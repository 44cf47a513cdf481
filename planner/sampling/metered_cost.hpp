#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// MotionCost that counts its work, so that a planner stops after the same work on every machine. Caches the
/// latest result, because OMPL requests the cost of a motion and then its validity. Every place except start
/// and goal may become a turn, so a motion is allowed only if a route may turn at its ends
/// (MotionCost::turnAllowed()); otherwise routes composed of motions would be refused later. One object per
/// planning run; not thread-safe.
class MeteredCost {
 public:
  MeteredCost(std::shared_ptr<const costmap::CostGrid> map, const Segment& ends)
      : motion_(std::move(map)), ends_(ends) {}

  const MotionCost& motion() const noexcept { return motion_; }

  /// Exact cost [J]; infinite if the motion is not allowed.
  double operator()(const Segment& motion) const noexcept;

  /// Adds the work of one planner iteration: 100 cells.
  void iterated() const noexcept { work_ += 100; }

  /// Work so far [evaluated cell lengths].
  std::uint64_t work() const noexcept { return work_; }

 private:
  bool turnsAllowed(const Segment& motion) const noexcept;

  MotionCost motion_;
  Segment ends_;                                  // start and goal
  mutable Segment last_{{NAN, NAN}, {NAN, NAN}};  // equal to no motion
  mutable double last_cost_J_ = 0.0;
  mutable std::uint64_t work_ = 0;
};

}  // namespace talus::planner
