#pragma once

#include <limits>

#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {

/// Slip from which a reading bounds the ground, beyond any that a drive plans [-].
inline constexpr double kDangerSlip = 0.7;

/// Evidence of danger in a wheel's reading, channel by channel. A channel speaks for itself: what the others read,
/// whether they are missing, not finite or impossible, and what was read before or after takes nothing away. What it
/// says is a bound of the ground where it was read and of no other. Immutable; keeps a reference to the model.
///
/// slip      from 0.7 on, more than any drive plans, the ground pulls no more than the slope takes at that slip, and
///           two standard deviations; from
///           0.8 on, where the cost curves end, it is dangerous on that slope; from 0.9 on the wheel may as well have
///           stood, and the ground is dangerous in every heading. Above 1 or infinite counts as 1. The speeds of rim
///           and rover count as slip, if they say more.
/// sinkage   from the policy's threshold on, that deep at least; from 0.75 r on, where the entry angle leaves what the
///           pull is computed for, dangerous in every heading (ours)
/// torque    at the motor's limit: dangerous on that slope
///
/// Where the slope along the heading is not known it is the steepest descent there.
class DangerWatch {
 public:
  explicit DangerWatch(const GroundModel& model) : model_(model) {}

  /// `least_gradient`: the least that the slope along the heading may have been, rise over run.
  GroundBound hear(int class_index, const TelemetryReading& reading, double least_gradient) const;

  /// Of a reading that is suspected for another reason: its drawbar pull bounds the ground where it lies two standard
  /// deviations below its class.
  GroundBound hear(int class_index, const WheelObservation& suspected) const;

 private:
  double dangerousBelow(double gradient) const noexcept;
  double neverDriven() const noexcept;

  const GroundModel& model_;
};

}  // namespace talus::costmap
