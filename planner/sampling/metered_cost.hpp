#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// MotionCost that counts its work, so that a planner can be stopped after the same work on every machine,
/// and that stores its last result, since OMPL requests the cost of a motion and then its validity.
/// Any place but start and goal may become a turn, so a motion must be one that a route may turn into and out
/// of (MotionCost::turnAllowed): else the routes that a planner joins from motions are refused in the end.
/// One object a planning run: not thread-safe.
class MeteredCost {
 public:
  MeteredCost(std::shared_ptr<const costmap::CostGrid> map, const Segment& ends)
      : motion_(std::move(map)), ends_(ends) {}

  const MotionCost& motion() const noexcept { return motion_; }

  /// Exact cost in joules, infinite when the motion is not allowed.
  double operator()(const Segment& motion) const noexcept;

  /// Counts one iteration of a planner as a hundred cells.
  void iterated() const noexcept { work_ += 100; }

  /// Work done so far, in cells' lengths evaluated [-].
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
