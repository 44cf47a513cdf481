#pragma once

#include <memory>

#include <ompl/base/spaces/SE2StateSpace.h>

#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// Position and heading over a map as a space of OMPL's, joined by the rover's own shortest curves:
/// Reeds-Shepp, Dubins, or turns in place. Distance is their length, a turn in place as long as half a cell a
/// radian. OMPL 1.5.2's own Dubins space aborts the process on long ways (dubins.hpp). Immutable but for what
/// OMPL sets up.
class PoseSpace : public ompl::base::SE2StateSpace {
 public:
  /// Keeps the cost by reference.
  explicit PoseSpace(const PoseCost& cost);

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
