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

/// What is wrong with one sensor of a rover, all the way.
enum class SensorFault {
  None,
  SlipStuck,      ///< one wheel's slip stays at what it first read
  SlipBiased,     ///< one wheel's slip reads 0.2 less
  OdometryStuck,  ///< the slip of all wheels stays at what it first read
  TorqueOffset,   ///< one wheel's torque reads more by 0.15 of load times radius
  SinkageDatum,   ///< one wheel's sinkage reads less by 0.1 of the radius
  Silent,         ///< one wheel reads nothing
  PoseDisplaced,  ///< the pose that is logged is 5 m off for 10 m of the way
};

/// "none", "slip_stuck", "slip_biased", "odometry_stuck", "torque_offset", "sinkage_datum", "silent",
/// "pose_displaced"; in the order of SensorFault.
const std::vector<std::string_view>& sensorFaultNames();

/// Greatest drift of the estimated pose per metre driven [-]: with one of 1 a rover that drives to its goal never takes itself to
/// be there.
inline constexpr double kMostPoseDrift = 0.5;

/// How well a simulated rover senses. Plain data.
struct SensorOptions {
  bool noise =
      true;  ///< of slip (0.02), slip angle (0.02 rad), torque (5 %), sinkage (3 %), and missing values
  double dropout = 0.02;  ///< share of torque and sinkage values that are missing, with noise
  double pose_drift =
      0.01;  ///< by which the believed pose leaves the true one, per metre driven, in [0, kMostPoseDrift] [-]
  SensorFault fault = SensorFault::None;
  std::uint64_t seed = 1;
};

/// What the wheels of a rover read at one look.
struct WheelLook {
  double heading_rad = 0.0;
  double slip_angle_rad = 0.0;  ///< from the wheels' planes to the way made good, as visual odometry sees it
  std::vector<costmap::WheelReading> wheels;  ///< the foremost first, at the believed place; NaN = missing
};

/// A look as rows of telemetry, for DriveIntake: wheels named w1, w2, ... A wheel without slip has no row.
terramech::Telemetry telemetryOf(const WheelLook& look);

/// The sensors of one rover on one drive: noise, dropouts, a pose that drifts, one fault. The wheel that has
/// the fault is drawn. Deterministic in the seed.
class SimulatedSensors {
 public:
  SimulatedSensors(const SensorOptions& options, const terramech::Rover& rover);

  /// Where the rover takes itself to be when it stands at a true place.
  maps::Point believed(const maps::Point& place) const noexcept;
  /// The rover drove on by so much.
  void moved(double distance_m);

  /// A moment of the drive.
  struct Moment {
    double time_s = 0.0;
    costmap::Direction heading;
    double gradient = 0.0;  ///< along the heading as the map has it
    double across = 0.0;    ///< the same to the left of it
    double dug_m = 0.0;     ///< depth of the holes that the wheels dug on the spot
  };
  /// What the wheels read.
  WheelLook look(const TrueWorld::Step& step, const Moment& moment);

  /// The wheel with the fault, by number.
  std::size_t faultyWheel() const noexcept { return faulty_wheel_; }

 private:
  void spoil(costmap::WheelReading& reading, std::size_t wheel);
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
