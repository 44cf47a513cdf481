#pragma once

#include <limits>

#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {

/// Slip from which a reading bounds the strength of the ground; greater than the slips of any planned drive
/// [-].
inline constexpr double kDangerSlip = 0.7;

/// Computes bounds of the strength of the ground from the reading of one wheel. Each channel of a reading is
/// checked for danger separately: neither missing, infinite or impossible values of other channels nor other
/// readings reduce the bound. A bound applies only to the ground where the reading was taken. Immutable;
/// keeps a reference to the model.
///
/// Slip: from 0.7 on, drawbar pull over load DP/W of the ground is at most that of the class, plus the slope,
/// minus the gradient at which a wheel on the class has that slip, plus 0.05 (two standard deviations). From
/// 0.8 on, the end of the cost curves, the ground is dangerous on that slope. From 0.9 on, the wheel may have
/// been stationary, and the ground is dangerous in every heading. A slip above 1 counts as 1. The slip from
/// rim speed and rover speed is used if it is greater.
///
/// Sinkage: from the policy's threshold on, sinkage over wheel radius z/r of the ground is at least the
/// measured z/r. From 0.75 on, where the entry angle leaves the range of the pull equation, the ground is
/// dangerous in every heading (ours).
///
/// Torque: from the limit of the motor on, the ground is dangerous on that slope.
///
/// If the slope along the heading is unknown, the steepest descent at the position is used.
class DangerWatch {
 public:
  explicit DangerWatch(const GroundModel& model) : model_(model) {}

  /// Returns the bound from one reading on ground of a class. `least_gradient` is the lowest possible
  /// gradient along the heading, rise over run [-].
  GroundBound bound(int class_index, const TelemetryReading& reading, double least_gradient) const;

  /// Returns the bound from a suspected reading: its DP/W, if this lies below that of the class by more than
  /// two standard deviations.
  GroundBound bound(int class_index, const WheelObservation& suspected) const;

 private:
  double dangerousBelow(double gradient) const noexcept;
  double dangerousInEveryHeading() const noexcept;

  const GroundModel& model_;
};

}  // namespace talus::costmap
