#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/State.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// OMPL state space of the map plane: R^2 in map coordinates [m], bounded by the edges of the map. The
/// projection has squares of 16 x 16 cells (the default projection of OMPL aborts in R^2).
class MapSpace : public ompl::base::RealVectorStateSpace {
 public:
  explicit MapSpace(const maps::Grid& grid);

  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the map coordinates [m] of a state of this space.
  static maps::Point place(const ompl::base::State* state) noexcept {
    const double* values = state->as<StateType>()->values;
    return {values[0], values[1]};
  }

  /// Sets a state of this space to a map position.
  static void setPlace(ompl::base::State* state, maps::Point place) noexcept {
    double* values = state->as<StateType>()->values;
    values[0] = place.x_m;
    values[1] = place.y_m;
  }

  void registerProjections() override;

 private:
  maps::Grid grid_;
};

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

/// Validity of states of MapSpace: a state is valid if its cell allows some heading.
class MapValidityChecker : public ompl::base::StateValidityChecker {
 public:
  MapValidityChecker(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool isValid(const ompl::base::State* state) const override;

 private:
  std::shared_ptr<const MeteredCost> cost_;
};

/// Validity of straight motions between states of MapSpace: a motion is valid if every crossed cell allows
/// its heading. The validity of the reverse motion may differ. The check is exact; the motion is not sampled.
class MapMotionValidator : public ompl::base::MotionValidator {
 public:
  MapMotionValidator(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Checks the motion and stores in `last_valid` its last valid state, found by bisection to 1/256 of the
  /// motion.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  bool allowed(const ompl::base::State* from, const ompl::base::State* to) const;

  std::shared_ptr<const MeteredCost> cost_;
};

}  // namespace talus::planner
