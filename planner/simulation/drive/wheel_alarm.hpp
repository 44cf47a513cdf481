#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// Limits of the alarm of a rover that monitors its wheels.
struct AlarmLimits {
  double slip = 0.2;  ///< slip above the larger of the expected slip and 0, at half of the wheels or more [-]
  /// Sinkage of a wheel on fresh ground above the expected sinkage, over the wheel radius [-].
  double sinkage = 0.08;
  double slip_angle_rad = 0.15;  ///< magnitude of the slip angle above the expected magnitude
};

/// Readings expected by the map for the ground under a wheel and a heading.
struct WheelExpectation {
  double slip = 0.0;                 ///< [-]
  double sinkage_over_radius = 0.0;  ///< [-]
  double slip_angle_rad = 0.0;       ///< magnitude; NaN (not known) is read as 0
};

/// Compares the wheels' readings, including noise and faults, with the map's expectations. Half of the wheels
/// must slip, so that a single sensor neither stops the rover nor prevents a stop. A single sinking wheel
/// suffices, because it is the first to reach soft ground. A constant offset of a wheel's sinkage is its
/// datum and is subtracted (ours: the median of its last 120 readings).
class WheelAlarm {
 public:
  /// The wheel radius [m] normalises sinkages, > 0.
  WheelAlarm(const AlarmLimits& limits, double wheel_radius_m) : limits_(limits), radius_m_(wheel_radius_m) {}

  /// Result of one set of readings.
  struct AlarmCheck {
    std::optional<std::string> reason;  ///< "slips", "slides" or "sinks"; empty without an alarm
    std::vector<bool> sank;             ///< for each wheel: true if its sinkage exceeds the limit
  };
  /// Compares readings with expectations; `expected` has one entry per wheel of `look`.
  AlarmCheck check(const WheelMeasurements& look, const std::vector<WheelExpectation>& expected);

 private:
  double excessSinkage(std::size_t wheel, const costmap::TelemetryReading& reading,
                       const WheelExpectation& expected);

  AlarmLimits limits_;
  double radius_m_;
  std::vector<std::deque<double>> excess_;  // of each wheel's latest readings
};

}  // namespace talus::planner
