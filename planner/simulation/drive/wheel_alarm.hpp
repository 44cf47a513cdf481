#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// Limits of the wheel readings at which the wheel monitor of a rover raises an alarm.
struct AlarmLimits {
  /// Limit of slip - max(expected slip, 0) [-]; at least half of the wheels must exceed it.
  double slip = 0.2;
  /// Limit of (sinkage - expected sinkage) / wheel radius for one wheel on ground without ruts [-].
  double sinkage = 0.08;
  double slip_angle_rad = 0.15;  ///< limit of |slip angle| - |expected slip angle|
};

/// Readings that the map predicts for the ground under a wheel and a heading.
struct WheelExpectation {
  double slip = 0.0;                 ///< expected slip [-]
  double sinkage_over_radius = 0.0;  ///< expected sinkage / wheel radius [-]
  double slip_angle_rad = 0.0;       ///< magnitude of the expected slip angle; NaN (not known) counts as 0
};

/// Wheel monitor: compares the readings of the wheels, including noise and faults, with the readings that the
/// map predicts. At least half of the wheels with a slip reading must slip, so that a single faulty sensor
/// neither stops the rover nor prevents a stop. One sinking wheel suffices for an alarm, because the first
/// wheel on soft ground sinks alone. A constant offset between measured and expected sinkage of a wheel is a
/// zero error of the sensor and is subtracted (ours: the median of the last 120 readings of the wheel).
class WheelAlarm {
 public:
  /// `wheel_radius_m` > 0 is the radius by which sinkage is divided.
  WheelAlarm(const AlarmLimits& limits, double wheel_radius_m) : limits_(limits), radius_m_(wheel_radius_m) {}

  /// Result of one set of readings.
  struct AlarmCheck {
    std::optional<std::string> reason;  ///< "slips", "slides" or "sinks"; empty without an alarm
    std::vector<bool> sank;             ///< for each wheel: true if its sinkage exceeds the limit
  };
  /// Compares the readings `look` with the predictions `expected`, which has one entry per wheel of `look`.
  AlarmCheck check(const WheelMeasurements& look, const std::vector<WheelExpectation>& expected);

 private:
  double excessSinkage(std::size_t wheel, const costmap::TelemetryReading& reading,
                       const WheelExpectation& expected);

  AlarmLimits limits_;
  double radius_m_;
  std::vector<std::deque<double>> excess_;  // of each wheel's latest readings
};

}  // namespace talus::planner
