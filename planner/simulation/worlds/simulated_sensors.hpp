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
  SlipStuck,      ///< the slip reading of one wheel keeps its first value
  SlipBiased,     ///< the slip reading of one wheel is 0.2 too low
  OdometryStuck,  ///< the slips of all wheels, also by their speeds, keep their first value
  TorqueOffset,   ///< the torque reading of one wheel is too high by 0.15 * load * radius
  SinkageDatum,   ///< the sinkage reading of one wheel is too low by 0.1 * radius
  Silent,         ///< one wheel has no readings of slip, torque and sinkage
  PoseDisplaced,  ///< the logged position has an error of 5 m during 10 m of the drive
};

/// Returns the names of the faults in the order of SensorFault: "none", "slip_stuck", "slip_biased",
/// "odometry_stuck", "torque_offset", "sinkage_datum", "silent", "pose_displaced".
const std::vector<std::string_view>& sensorFaultNames();

/// Upper limit of the drift of the estimated position per metre driven [-]. With a drift of 1, the estimated
/// position of a rover that drives to its goal may never reach the goal.
inline constexpr double kMostPoseDrift = 0.5;

/// Quality of the sensors of a simulated rover. Plain data.
struct SensorOptions {
  /// True: the readings have noise with the standard deviations slip 0.02, slip angle 0.02 rad, torque 5 %
  /// and sinkage 3 %, and some values are missing.
  bool noise = true;
  double dropout = 0.02;     ///< share of missing torque and sinkage values, [0, 1]; only with `noise`
  double pose_drift = 0.01;  ///< drift of the estimated position per metre driven, [0, kMostPoseDrift] [-]
  bool second_slip = true;   ///< rim speed and odometry are measured: a second slip with a noise of 0.03
  SensorFault fault = SensorFault::None;  ///< fault of one sensor
  std::uint64_t seed = 1;  ///< seed of the noise, the drift direction and the choice of the faulty wheel
};

/// Readings of all wheels of a rover at one time.
struct WheelMeasurements {
  double heading_rad = 0.0;  ///< heading of the rover
  /// Angle from the wheel planes to the direction of travel, measured by visual odometry.
  double slip_angle_rad = 0.0;
  double rim_speed_mps = 0.0;
  std::vector<costmap::TelemetryReading>
      wheels;  ///< front wheels first, at estimated positions; NaN: missing value
};

/// Converts readings to rows of telemetry for DriveIntake. The wheels have the names w1, w2, ... A wheel
/// without a slip reading has no row.
terramech::Telemetry telemetryOf(const WheelMeasurements& look);

/// Simulated sensors of one rover on one drive, with noise, missing values, a drifting position and at most
/// one fault. The faulty wheel is drawn at random. Deterministic for a given seed.
class SimulatedSensors {
 public:
  /// Throws std::invalid_argument if pose_drift is out of range.
  SimulatedSensors(const SensorOptions& options, const terramech::Rover& rover);

  /// Returns the estimated position of the rover at the true position `place`.
  maps::Point estimatedPlace(const maps::Point& place) const noexcept;
  /// Adds a distance driven by the rover, by which the estimated position drifts.
  void moved(double distance_m);

  /// State of the drive at one time.
  struct Moment {
    double time_s = 0.0;         ///< time since the start
    costmap::Direction heading;  ///< heading of the motion
    double gradient = 0.0;       ///< gradient of the ground along the heading, from the map, rise over run
    double across = 0.0;  ///< gradient of the ground to the left of the heading, from the map, rise over run
    double dug_m = 0.0;   ///< depth of the holes that the wheels dug while the rover did not move
  };
  /// Returns the readings of the wheels, with noise and faults, for the true state `step` of the rover.
  WheelMeasurements look(const TrueWorld::Step& step, const Moment& moment);

  /// Returns the index of the wheel to which the fault applies.
  std::size_t faultyWheel() const noexcept { return faulty_wheel_; }

 private:
  void spoil(costmap::TelemetryReading& reading, std::size_t wheel);
  bool drops();

  SensorOptions options_;
  terramech::Rover rover_;
  std::mt19937_64 random_, random_speed_;
  std::normal_distribution<double> normal_, normal_speed_;
  maps::Point drift_, drift_per_m_;
  double driven_m_ = 0.0, displaced_from_m_ = 0.0;
  std::size_t faulty_wheel_ = 0;
  std::optional<double> stuck_slip_;
};

}  // namespace talus::planner
