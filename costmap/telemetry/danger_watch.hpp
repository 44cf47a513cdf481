#pragma once

#include <limits>

#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {

/// Slip from which a reading bounds the ground, above the slips of any planned drive [-].
inline constexpr double kDangerSlip = 0.7;

/// Bounds of the ground from the reading of one wheel. Each channel of a reading is checked for danger
/// separately: neither missing, infinite or impossible values of other channels nor other readings reduce the
/// bound. A bound applies only to the ground where the reading was taken. Immutable; keeps a reference to the
/// model.
///
/// slip     from 0.7 on, drawbar pull over load (DP/W) is at most that of the class, plus the slope, minus
///          the gradient of the class at that slip, plus 0.05 (two standard deviations); from 0.8 on, the end
///          of the cost curves, the ground is dangerous on that slope; from 0.9 on the wheel may have been
///          stationary, and the ground is dangerous in every heading. A slip above 1 counts as 1. The slip
///          from rim speed and rover speed is used if greater.
/// sinkage  from the policy's threshold on, z/r of the ground is at least the measured z/r; from 0.75 on,
///          where the entry angle leaves the range of the pull equation, the ground is dangerous in every
///          heading (ours)
/// torque   from the limit of the motor on, the ground is dangerous on that slope
///
/// If the slope along the heading is unknown, the steepest descent at the place is used.
class DangerWatch {
 public:
  explicit DangerWatch(const GroundModel& model) : model_(model) {}

  /// Returns the bound from one reading. `least_gradient`: lowest possible slope along the heading, rise over
  /// run [-].
  GroundBound bound(int class_index, const TelemetryReading& reading, double least_gradient) const;

  /// Returns the bound from a suspected reading: its drawbar pull, if at least two standard deviations below
  /// the class.
  GroundBound bound(int class_index, const WheelObservation& suspected) const;

 private:
  double dangerousBelow(double gradient) const noexcept;
  double dangerousInEveryHeading() const noexcept;

  const GroundModel& model_;
};

}  // namespace talus::costmap
