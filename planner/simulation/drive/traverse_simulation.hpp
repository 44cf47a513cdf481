#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/drive/wheel_alarm.hpp>
#include <talus/planner/simulation/worlds/simulated_sensors.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::planner {

struct Plan;
struct Problem;

/// Outcome of a simulated drive.
enum class Outcome {
  Reached,      ///< the goal was reached
  Immobilised,  ///< no slip gave the required drawbar pull, neither forward nor back, or the rover did not
                ///< monitor its slip
  Tipped,       ///< the true slope exceeded 1.5 times the rover's pitch or roll limit
  GaveUp,       ///< no route left on the planner's map, too many replans, or cancelled
  Slid,         ///< the wheels did not hold the rover across or down a slope, neither forward nor back
};

/// "reached", "immobilised", "tipped", "gave_up", "slid".
std::string_view name(Outcome outcome) noexcept;

/// One step of a drive: the map's prediction and the true state.
struct TraverseStep {
  double time_s = 0.0;                   ///< at the beginning of the step
  maps::Point place;                     ///< true position [m]
  costmap::Direction heading;            ///< heading of the motion
  double gradient = 0.0;                 ///< along the heading, rise over run
  double length_m = 0.0;                 ///< in the map plane
  double expected_slip = 0.0;            ///< slip predicted by the map [-]
  double expected_energy_J_per_m = 0.0;  ///< per metre of surface length
  TrueWorld::Step truth;                 ///< true state of the rover
};

/// Parameters of a traverse simulation.
struct SimulationOptions {
  maps::Point start;              ///< map coordinates [m]
  maps::Point goal;               ///< map coordinates [m]
  double goal_tolerance_m = 0.0;  ///< >= 0
  /// True: the rover monitors its wheels, updates the map and replans. False: it drives the first route
  /// without sensing.
  bool senses = true;
  AlarmLimits alarm{};      ///< limits at which the rover stops and reverses
  SensorOptions sensors{};  ///< quality of the sensors
  /// Smallest distance reversed after an alarm, and largest radius of the ground refused around a wheel after
  /// an alarm.
  double keep_out_radius_m = 1.0;
  /// Rim travel on the spot before the rover detects that it does not move (ours: a quarter of a small
  /// wheel's diameter, the resolution of visual odometry).
  double stall_detection_m = 0.06;
  double step_m = 0.03;             ///< distance between two readings of the wheels, > 0
  double sensing_interval_m = 0.5;  ///< distance between two updates of the map from readings, > 0
  int max_replans = 60;             ///< more replans end the drive with GaveUp
  std::function<void(const TraverseStep&)> on_step = {};  ///< called before every step driven forward
  bool record = false;                                    ///< keep the wheels' readings
  std::function<void(double time_s)> on_learned = {};     ///< called after the map changed
  ProgressMonitor watch = {};                             ///< stops the simulation
  std::function<Plan(const Problem&)> planner = {};       ///< called for every route; empty: FieldPlanner
};

/// State at one point of a simulated drive.
struct TrackPoint {
  maps::Point place;       ///< true position [m]
  double time_s = 0.0;     ///< since the start
  double energy_J = 0.0;   ///< since the start
  double slip = 0.0;       ///< slip of the step that ended here
  double sinkage_m = 0.0;  ///< largest sinkage of a wheel in that step
};

/// Event of the drive: "planned", "reversed", "turned downhill", the reason of an alarm ("slips", "slides",
/// "sinks"), "soil weaker than estimated", or the name of the outcome.
struct TraverseEvent {
  double time_s = 0.0;             ///< since the start
  std::string text;                ///< name of the event
  std::vector<maps::Point> route;  ///< the planned route; only for the event "planned"
};

/// Reading of one wheel at one time, including noise and faults.
struct WheelRecord {
  std::size_t wheel = 0;              ///< foremost wheels first
  double heading_rad = 0.0;           ///< heading of the rover
  costmap::TelemetryReading reading;  ///< as given to the map
};

/// Result of a traverse simulation.
struct TraverseSimulation {
  Outcome outcome = Outcome::GaveUp;
  std::string cause;      ///< one line, for outcomes other than Reached and Tipped; else empty
  double energy_J = 0.0;  ///< including turns and spinning on the spot
  double time_s = 0.0;    ///< duration of the drive
  double length_m = 0.0;  ///< distance driven, including reversing
  double max_slip = 0.0;  ///< largest slip of a forward step [-]
  int replans = 0;
  int alarms = 0;                     ///< alarms after which the rover reversed and refused ground
  std::vector<TrackPoint> track;      ///< positions after every step
  std::vector<TraverseEvent> events;  ///< events in order of time
  std::vector<WheelRecord> records;   ///< if SimulationOptions::record is set
};

/// Drives a rover over a true world with the map as its knowledge, and updates the map: the simulated
/// sensors' readings pass through DriveIntake, like a telemetry file. A rover that senses monitors its wheels
/// at every step; at an alarm it reverses in its own ruts and replans. Only the simulated physics uses the
/// true world. Deterministic for a given sensor seed.
TraverseSimulation simulateTraverse(costmap::TraversabilityMap& map, const TrueWorld& world,
                                    const SimulationOptions& options);

}  // namespace talus::planner
