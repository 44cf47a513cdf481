#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/map/traversability_map.hpp>
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

/// Drive states and wheel readings that the map predicts for a step, before the readings of that step update
/// the map. The slope is that of the cell under the centre of the rover, because the rover measures its own
/// slope. The map must outlive the object.
class MapExpectation {
 public:
  /// `slope` is the code of the cell under the centre of the rover; only the gradient of the ground in this
  /// code is used.
  MapExpectation(const costmap::TraversabilityMap& map, costmap::CellCode slope) : map_(map), slope_(slope) {}

  /// Returns the predicted drive state at `place` on `heading`. If the map excludes the cell of the place,
  /// the state is that of the terrain class of the cell. Outside the map all values are 0.
  costmap::TravelState at(const maps::Point& place, const costmap::Direction& heading) const;

  /// Returns the predicted readings of a wheel at `place`. The ground is assumed to be at least as strong as
  /// its terrain class; otherwise ground that was just estimated as weak would raise no alarm. `middle` is
  /// the centre of the rover; the slip predicted there applies to all wheels.
  WheelExpectation ofWheel(const maps::Point& place, const maps::Point& middle,
                           const costmap::Direction& heading) const;

 private:
  costmap::TravelState ofClass(const maps::Point& place, const costmap::Direction& heading) const;
  costmap::CellCode onSlope(costmap::CellCode::Curve curve) const;
  costmap::CellCode::Curve classCurve(maps::Cell cell) const noexcept;

  const costmap::TraversabilityMap& map_;
  costmap::CellCode slope_;
};

}  // namespace talus::planner
