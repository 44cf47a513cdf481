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
  Reached,  ///< the goal was reached
  /// No slip gave the required drawbar pull forward or in reverse, or a rover without sensing got stuck.
  Immobilised,
  Tipped,  ///< the true slope exceeded 1.5 times the rover's pitch or roll limit
  GaveUp,  ///< the planner found no route, the number of replans exceeded its limit, or a stop was requested
  Slid,  ///< the side forces of the wheels did not hold the rover on a slope, neither forward nor in reverse
};

/// Returns "reached", "immobilised", "tipped", "gave_up" or "slid".
std::string_view name(Outcome outcome) noexcept;

/// One forward step of a drive: the prediction of the map and the true state.
struct TraverseStep {
  double time_s = 0.0;                   ///< time at the beginning of the step, since the start of the drive
  maps::Point place;                     ///< true position at the beginning of the step [m]
  costmap::Direction heading;            ///< heading of the motion
  double gradient = 0.0;                 ///< true gradient of the ground along the heading, rise over run
  double length_m = 0.0;                 ///< length of the step in the map plane
  double expected_slip = 0.0;            ///< slip predicted by the map [-]
  double expected_energy_J_per_m = 0.0;  ///< energy per metre of surface length predicted by the map
  TrueWorld::Step truth;                 ///< true state of the rover during the step
};

/// Parameters of a traverse simulation.
struct SimulationOptions {
  maps::Point start;              ///< start of the drive, map coordinates [m]
  maps::Point goal;               ///< goal of the drive, map coordinates [m]
  double goal_tolerance_m = 0.0;  ///< permitted distance of the end from the goal, >= 0
  /// True: the rover monitors its wheels, updates the map and replans. False: the rover drives the first
  /// route without these functions.
  bool senses = true;
  AlarmLimits alarm{};      ///< limits of the wheel readings at which the rover stops and reverses
  SensorOptions sensors{};  ///< quality of the sensors
  /// Smallest distance that the rover reverses after an alarm [m]. It is also the largest radius of the area
  /// around a wheel that is then excluded from the map.
  double keep_out_radius_m = 1.0;
  /// Travel of the wheel rim without motion of the rover, after which the rover detects the stall [m] (ours:
  /// a quarter of the diameter of a small wheel, the resolution of visual odometry).
  double stall_detection_m = 0.06;
  double step_m = 0.03;             ///< distance between two readings of the wheels, > 0
  double sensing_interval_m = 0.5;  ///< distance between two updates of the map from the readings, > 0
  int max_replans = 60;  ///< largest number of replans; a further replan ends the drive with GaveUp
  std::function<void(const TraverseStep&)> on_step = {};  ///< called before every forward step
  bool record = false;  ///< true: store the readings of the wheels in TraverseSimulation::records
  /// Called after every update of the map, with the time since the start.
  std::function<void(double time_s)> on_learned = {};
  ProgressMonitor watch = {};                        ///< requests a stop of the simulation
  std::function<Plan(const Problem&)> planner = {};  ///< planner of every route; empty: FieldPlanner
};

/// State at one point of a simulated drive.
struct TrackPoint {
  maps::Point place;       ///< true position [m]
  double time_s = 0.0;     ///< time since the start of the drive
  double energy_J = 0.0;   ///< energy used since the start of the drive
  double slip = 0.0;       ///< slip of the step that ended at this point [-]
  double sinkage_m = 0.0;  ///< largest sinkage of the wheels in that step
};

/// Event of the drive. Its text is "planned", "reversed", "turned downhill", the reason of an alarm ("slips",
/// "slides", "sinks"), "soil weaker than estimated", or the name of the outcome.
struct TraverseEvent {
  double time_s = 0.0;             ///< time since the start of the drive
  std::string text;                ///< text of the event
  std::vector<maps::Point> route;  ///< vertices of the planned route [m]; only for the event "planned"
};

/// Reading of one wheel at one time, including sensor noise and sensor faults.
struct WheelRecord {
  std::size_t wheel = 0;              ///< index of the wheel; the front wheels have the lowest indices
  double heading_rad = 0.0;           ///< heading of the rover
  costmap::TelemetryReading reading;  ///< values with which the map is updated
};

/// Result of a traverse simulation.
struct TraverseSimulation {
  /// Outcome of the drive.
  Outcome outcome = Outcome::GaveUp;
  std::string cause;      ///< one line with the cause; empty for Reached and Tipped
  double energy_J = 0.0;  ///< energy of the drive, including turns and spinning on the spot
  double time_s = 0.0;    ///< duration of the drive
  double length_m = 0.0;  ///< distance driven, including reversing
  double max_slip = 0.0;  ///< largest slip of a forward step [-]
  int replans = 0;        ///< number of plans after the first plan
  int alarms = 0;  ///< number of alarms after which the rover reversed and excluded ground from the map
  std::vector<TrackPoint> track;      ///< states after every step
  std::vector<TraverseEvent> events;  ///< events in order of time
  /// Readings of the wheels; empty unless SimulationOptions::record is true.
  std::vector<WheelRecord> records;
};

/// Simulates the drive of a rover over the true world `world`. The rover plans with `map`, which is updated
/// during the drive. The readings of the simulated sensors pass through DriveIntake, in the same way as a
/// telemetry file. A rover with SimulationOptions::senses monitors its wheels at every step; at an alarm it
/// reverses in its own ruts and replans. Only the simulated physics uses the true world. Deterministic for a
/// given sensor seed.
TraverseSimulation simulateTraverse(costmap::TraversabilityMap& map, const TrueWorld& world,
                                    const SimulationOptions& options);

}  // namespace talus::planner
