#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// When a rover that watches its wheels stops.
struct AlarmLimits {
  double slip = 0.2;  ///< slip beyond what the map says and beyond 0, at half of the wheels or more [-]
  double sinkage =
      0.08;  ///< sinkage of a wheel on fresh ground beyond what the map says, over its radius [-]
  double slip_angle_rad = 0.15;  ///< slip angle of the way made good beyond what the map says, as sizes
};

/// What the map says of the ground under a wheel in this heading.
struct WheelExpectation {
  double slip = 0.0;                 ///< [-]
  double sinkage_over_radius = 0.0;  ///< [-]
  double slip_angle_rad = 0.0;       ///< size; NaN, not known, counts as 0
};

/// Compares what the wheels read, noise and faults and all, with what the map says. Half of the wheels must
/// slip, so that one wheel's sensor neither stops the rover nor keeps it from stopping. One wheel that sinks
/// is enough: it is the first to meet soft ground. An offset of a wheel's sinkage that it had all the way is
/// its datum and taken off (ours: the median of its last 120 looks).
class WheelAlarm {
 public:
  WheelAlarm(const AlarmLimits& limits, double wheel_radius_m) : limits_(limits), radius_m_(wheel_radius_m) {}

  /// What a look says.
  struct Heard {
    std::optional<std::string> reason;  ///< "slips", "slides" or "sinks"
    std::vector<bool> sank;             ///< of each wheel
  };
  /// `expected`: of each wheel of the look.
  Heard hear(const WheelLook& look, const std::vector<WheelExpectation>& expected);

 private:
  double excessSinkage(std::size_t wheel, const costmap::WheelReading& reading,
                       const WheelExpectation& expected);

  AlarmLimits limits_;
  double radius_m_;
  std::vector<std::deque<double>> excess_;  // of each wheel's last looks
};

}  // namespace talus::planner
