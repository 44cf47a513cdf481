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

/// How a simulated drive ended.
enum class Outcome {
  Reached,      ///< the goal
  Immobilised,  ///< no slip gave the pull, neither on nor back, or nobody was watching the slip
  Tipped,       ///< the true ground was steeper than the rover may stand
  GaveUp,       ///< no route is left under what is believed
  Slid,         ///< its wheels did not hold it across or down a slope, neither on nor back
};

/// "reached", "immobilised", "tipped", "gave_up", "slid".
std::string_view name(Outcome outcome) noexcept;

/// One step of a drive: what the map said of it before, and what it was.
struct DriveStep {
  double time_s = 0.0;
  maps::Point place;
  costmap::Direction heading;
  double gradient = 0.0;
  double length_m = 0.0;
  double expected_slip = 0.0;
  double expected_energy_J_per_m = 0.0;  ///< along the surface
  TrueWorld::Step truth;
};

/// What a traverse simulation does.
struct SimulationOptions {
  maps::Point start;
  maps::Point goal;
  double goal_tolerance_m = 0.0;  ///< >= 0
  /// The rover watches its wheels, learns and replans; else it drives the first route blindly.
  bool senses = true;
  AlarmLimits alarm{};      ///< at which it stops and backs out
  SensorOptions sensors{};  ///< how well it senses
  /// So far it backs out at least, and so wide a berth it gives the ground that gave the alarm.
  double keep_out_radius_m = 1.0;
  double stall_detection_m =
      0.06;              ///< rim travel on the spot before a rover that does not move notices (ours: a
                         ///< quarter of a small wheel's diameter, as visual odometry resolves)
  double step_m = 0.03;  ///< between two looks at the wheels, > 0
  double sensing_interval_m = 0.5;  ///< between two readings of the wheels that the map learns from, > 0
  int max_replans = 60;             ///< then it gives up
  std::uint64_t seed = 1;           ///< of the sensors' noise
  std::function<void(const DriveStep&)> on_step = {};  ///< called for every step that leads on
  bool record = false;                                 ///< keep what the wheels read
  std::function<void(double time_s)> on_learned = {};  ///< called after the map changed
  ProgressMonitor watch = {};
  std::function<Plan(const Problem&)> planner = {};  ///< asked for every route; none: the field's
};

/// A moment of a simulated drive.
struct TrackPoint {
  maps::Point place;
  double time_s = 0.0;
  double energy_J = 0.0;
  double slip = 0.0;       ///< of the step that led here
  double sinkage_m = 0.0;  ///< of the deepest wheel in that step
};

/// Something worth telling: "planned", "slips", "backed out", "stuck".
struct DriveEvent {
  double time_s = 0.0;
  std::string text;
  std::vector<maps::Point> route;  ///< where it planned one
};

/// What one wheel read at one look, noise and all.
struct WheelRecord {
  std::size_t wheel = 0;  ///< the foremost first
  double heading_rad = 0.0;
  costmap::WheelReading reading;
};

/// What came of it.
struct TraverseSimulation {
  Outcome outcome = Outcome::GaveUp;
  std::string cause;  ///< of not reaching the goal, in one line; empty where it did
  double energy_J = 0.0;
  double time_s = 0.0;
  double length_m = 0.0;  ///< driven, backing out included
  double max_slip = 0.0;
  int replans = 0;
  int alarms = 0;  ///< times that it stopped and backed out
  std::vector<TrackPoint> track;
  std::vector<DriveEvent> events;
  std::vector<WheelRecord> records;  ///< where SimulationOptions::record asks for them
};

/// Drives a rover over a true world with what a map believes, changing the map as it learns: what its
/// simulated sensors read goes through DriveIntake, as a telemetry file does. A rover that senses watches its
/// wheels at every short step; at the alarm it backs out in its own ruts and plans anew. Only the physics know
/// the truth. Deterministic in the sensors' seed.
TraverseSimulation simulateTraverse(costmap::TraversabilityMap& map, const TrueWorld& world,
                                    const SimulationOptions& options);

}  // namespace talus::planner
