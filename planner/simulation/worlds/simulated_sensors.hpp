#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::planner {

/// Fault of one sensor, present during the whole drive.
enum class SensorFault {
  None,           ///< no fault
  SlipStuck,      ///< one wheel's slip stays at its first value
  SlipBiased,     ///< one wheel's slip reads 0.2 too low
  OdometryStuck,  ///< the slip of all wheels stays at its first value
  TorqueOffset,   ///< one wheel's torque reads too high by 0.15 of load times radius
  SinkageDatum,   ///< one wheel's sinkage reads too low by 0.1 of the radius
  Silent,         ///< one wheel gives no slip, torque or sinkage
  PoseDisplaced,  ///< the logged position is wrong by 5 m over 10 m of the drive
};

/// "none", "slip_stuck", "slip_biased", "odometry_stuck", "torque_offset", "sinkage_datum", "silent",
/// "pose_displaced"; in the order of SensorFault.
const std::vector<std::string_view>& sensorFaultNames();

/// Largest drift of the estimated position per metre driven [-]. With a drift of 1, the estimated position of
/// a rover that drives to its goal may never reach the goal.
inline constexpr double kMostPoseDrift = 0.5;

/// Quality of a simulated rover's sensors. Plain data.
struct SensorOptions {
  /// Noise of slip (0.02), slip angle (0.02 rad), torque (5 %) and sinkage (3 %), and missing values.
  bool noise = true;
  double dropout = 0.02;     ///< share of missing torque and sinkage values; only with noise
  double pose_drift = 0.01;  ///< drift of the estimated position per metre driven, in [0, kMostPoseDrift] [-]
  SensorFault fault = SensorFault::None;  ///< fault of one sensor
  std::uint64_t seed = 1;                 ///< seed of noise, drift direction and faulty wheel
};

/// Readings of all wheels of a rover at one time.
struct WheelMeasurements {
  double heading_rad = 0.0;     ///< heading of the rover
  double slip_angle_rad = 0.0;  ///< from the wheels' planes to the direction of travel, as measured by visual
                                ///< odometry
  std::vector<costmap::TelemetryReading>
      wheels;  ///< foremost wheels first, at estimated positions; NaN: missing
};

/// Readings as rows of telemetry for DriveIntake, with wheels named w1, w2, ... A wheel without slip has no
/// row.
terramech::Telemetry telemetryOf(const WheelMeasurements& look);

/// Sensors of one rover on one drive: noise, dropouts, a drifting position and at most one fault. The faulty
/// wheel is drawn at random. Deterministic for a given seed.
class SimulatedSensors {
 public:
  /// Throws std::invalid_argument if pose_drift is out of range.
  SimulatedSensors(const SensorOptions& options, const terramech::Rover& rover);

  /// Estimated position of the rover at a true place.
  maps::Point estimatedPlace(const maps::Point& place) const noexcept;
  /// Adds a driven distance.
  void moved(double distance_m);

  /// State of the drive at one time.
  struct Moment {
    double time_s = 0.0;         ///< since the start
    costmap::Direction heading;  ///< heading of the motion
    double gradient = 0.0;       ///< along the heading, from the map
    double across = 0.0;         ///< to the left of the heading, from the map
    double dug_m = 0.0;          ///< depth of the holes dug on the spot
  };
  /// Readings of the wheels, including noise and faults.
  WheelMeasurements look(const TrueWorld::Step& step, const Moment& moment);

  /// Returns the index of the wheel with the fault.
  std::size_t faultyWheel() const noexcept { return faulty_wheel_; }

 private:
  void spoil(costmap::TelemetryReading& reading, std::size_t wheel);
  bool drops();

  SensorOptions options_;
  terramech::Rover rover_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  maps::Point drift_, drift_per_m_;
  double driven_m_ = 0.0, displaced_from_m_ = 0.0;
  std::size_t faulty_wheel_ = 0;
  std::optional<double> stuck_slip_;
};

}  // namespace talus::planner
