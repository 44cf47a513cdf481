#pragma once

#include <memory>

#include <ompl/base/spaces/SE2StateSpace.h>

#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// OMPL state space of position and heading over a map. Two states are connected by the shortest path of the
/// rover: Reeds-Shepp, Dubins, or turns in place. The distance is the length of the path; a turn in place
/// adds half a cell per radian. The Dubins space of OMPL 1.5.2 is not used, because it aborts the process for
/// long paths (dubins.hpp). Immutable except for the setup by OMPL.
class PoseSpace : public ompl::base::SE2StateSpace {
 public:
  /// `cost` must outlive the object.
  explicit PoseSpace(const PoseCost& cost);

  /// Converts between states and poses.
  static Pose pose(const ompl::base::State* state) noexcept;
  static void setPose(ompl::base::State* state, const Pose& pose) noexcept;

  double distance(const ompl::base::State* from, const ompl::base::State* to) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double share,
                   ompl::base::State* state) const override;
  bool isMetricSpace() const override { return false; }
  bool hasSymmetricDistance() const override { return cost_.kinematics().may_reverse; }
  bool hasSymmetricInterpolate() const override { return cost_.kinematics().may_reverse; }
  void registerProjections() override;

 private:
  double weight_m(const PosePath::Leg& leg) const noexcept;

  const PoseCost& cost_;
  double radian_m_;
};

}  // namespace talus::planner
