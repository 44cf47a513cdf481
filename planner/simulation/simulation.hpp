#pragma once

/// Umbrella header of talus::simulation: simulated drives of a rover on true soils that may differ from the
/// soils of the planner's map.
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/planner.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {
struct TurnEffort;
}

namespace talus::planner {

/// Record of the ruts that the wheels of a rover made, on a grid of squares as wide as a wheel. A pressed
/// square counts as a rut only after the rover has driven a further distance of two squares or has reversed
/// its direction. Therefore a wheel does not drive in the rut that it is just making.
class Ruts {
 public:
  /// `wheel_width_m` > 0 is the side length of the squares.
  explicit Ruts(double wheel_width_m) : square_m_(wheel_width_m) {}

  /// Marks the square under a wheel at `place` (map coordinates).
  void press(const maps::Point& place);
  /// Adds a distance driven by the rover, >= 0.
  void moved(double distance_m) noexcept { odometer_m_ += distance_m; }
  /// Records that the rover reversed its direction: all squares pressed before count as ruts at once.
  void turnBack() noexcept { odometer_m_ += 3.0 * square_m_; }
  /// Returns the number of earlier wheel passes at `place`.
  int passes(const maps::Point& place) const;

 private:
  struct Mark {
    double pressed_at_m = 0.0;
    int passes = 1;
    int before = 0;  // passes before the present wheel
  };

  std::uint64_t square(const maps::Point& place) const noexcept;
  bool movedOn(const Mark& mark) const noexcept { return odometer_m_ - mark.pressed_at_m > 2.0 * square_m_; }

  double square_m_;
  double odometer_m_ = 0.0;
  std::unordered_map<std::uint64_t, Mark> marks_;
};

/// Table of the forces and the sinkage of a wheel on one soil with its effects (terramech::Effect), computed
/// with the forward model. The table has three dimensions: slip from -1 to 1 (index: row), load from 0.25 to
/// 1.9 times the load on level ground (index: layer), and slip angle from 0 to 45 degrees (index: sheet).
class SimulatedWheelTable {
 public:
  /// Entry of the table: normalised forces and sinkage.
  struct Row {
    double pull = 0.0;     ///< drawbar pull divided by load [-]
    double torque = 0.0;   ///< torque / (load * radius) [-]
    double sinkage = 0.0;  ///< sinkage divided by radius [-]
    double hold = 0.0;     ///< side force against the lateral motion of the wheel, divided by load [-]
  };

  static constexpr std::size_t kRows = 81;   ///< number of slip values
  static constexpr std::size_t kLoads = 12;  ///< number of load values
  static constexpr std::size_t kAngles = 9;  ///< number of slip-angle values

  /// Returns the load of a layer divided by the load on level ground, 0.25 to 1.9.
  static constexpr double load(std::size_t layer) noexcept {
    return 0.25 + 0.15 * static_cast<double>(layer);
  }

  /// Returns the slip angle of a sheet [rad], 0 to 45 degrees.
  static constexpr double angle_rad(std::size_t sheet) noexcept {
    return 0.09817477042468103 * static_cast<double>(sheet);
  }

  /// Computes the table. On a soil that cannot carry the wheel, the pull is -1 and the side force is 0.
  SimulatedWheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
                      const std::vector<terramech::Effect>& effects = {});

  /// Returns the slip of a row, -1 to 1.
  static constexpr double slip(std::size_t row) noexcept {
    return 2.0 * static_cast<double>(row) / (kRows - 1) - 1.0;
  }
  /// Returns the entry of row `i` and `sheet`, interpolated at the load `load_over_flat` (load divided by the
  /// load on level ground), which is clamped to the range of the table.
  Row row(std::size_t i, double load_over_flat, std::size_t sheet = 0) const noexcept;
  /// Returns the entry interpolated at a slip, a load and a slip angle, of which the sign is ignored. The
  /// arguments are clamped to the range of the table.
  Row at(double slip, double load_over_flat, double slip_angle_rad = 0.0) const noexcept;

 private:
  Row onSheet(double slip, double load_over_flat, std::size_t sheet) const noexcept;

  std::vector<Row> rows_;  // [sheet][load][slip]
};

/// Disc with a soil that differs from the soil of the class map.
struct SoilPatch {
  maps::Point centre;     ///< map coordinates [m]
  double radius_m = 0.0;  ///< radius of the disc, >= 0
  terramech::Soil soil;   ///< soil in the disc
};

/// Departures of the ground of a world from its soils, in drawbar pull over load at slip 0.5 [-]: one of each
/// class, and a Gaussian field over places with the correlation exp(-d / l), as a sum of random waves. Ground that
/// departs by D has 1 + D/H times the shear stresses of its soil, with the thrust H of its soil over load.
struct GroundDepartures {
  /// Wave numbers [1/m] and phase of a wave.
  struct Wave {
    double x, y, phase;
  };
  std::vector<double> of_class;   ///< departure of each class, in the order of the classes of the map
  std::vector<double> place_std;  ///< standard deviation of the field on each class
  std::vector<Wave> waves{};

  /// Returns the value of the field at a place, of variance 1.
  double field(const maps::Point& place) const noexcept;
};

/// True soils of a simulated world. The planner does not know them.
struct WorldSoils {
  /// True soil of each terrain class, in the order of the classes of the map.
  std::vector<terramech::Soil> classes;
  std::vector<SoilPatch> patches;  ///< patches with other soil; at an overlap the later patch counts
  /// Effects in addition to those of a rigid wheel; they act on all soils.
  std::vector<terramech::Effect> effects{};
  GroundDepartures departures{};  ///< empty: none
};

/// Position and motion of a rover.
struct Motion {
  maps::Point place;           ///< position of the centre of the rover, map coordinates [m]
  costmap::Direction heading;  ///< heading of the motion
  double gradient = 0.0;       ///< gradient of the ground along the motion, rise over run
  double across = 0.0;         ///< gradient of the ground to the left of the motion, rise over run
  double dug_m = 0.0;          ///< depth of the holes out of which the wheels must climb
  const Ruts* ruts = nullptr;  ///< record of the ruts; null: no ground has ruts
};

/// Statics of a rover with identical wheels on the true soils. Each wheel stands on the soil at its position,
/// in a rut if a wheel passed there before, and carries its share of the weight. All wheels turn at the same
/// rate and are steered uphill by the same angle; therefore slip and slip angle are the same for all wheels.
/// Together the wheels give the forces required along and across the direction of travel (ishigami_2009). The
/// yaw moment is assumed to be balanced by the steering.
///
/// The model is quasi-static. Immutable, safe to share between threads.
class TrueWorld {
 public:
  /// `class_index` contains for each cell the index of its terrain class in `soils.classes`.
  TrueWorld(const WorldSoils& soils, const terramech::Rover& rover, maps::Raster<std::uint8_t> class_index);

  /// State of one wheel during a step.
  struct SimulatedWheel {
    maps::Point place;                ///< position of the wheel [m]
    double load_N = 0.0;              ///< normal load of the wheel
    int passes = 0;                   ///< number of earlier wheel passes at this position
    SimulatedWheelTable::Row forces;  ///< normalised forces and sinkage
  };

  /// Steady state of the rover during one step.
  struct Step {
    bool stuck = false;           ///< true: no slip gives the required drawbar pull, or the rover slides
    bool slides = false;          ///< true: no slip angle up to 45 deg holds the rover on the slope
    double slip = 0.0;            ///< slip of all wheels, -1 to 0.98 [-]; 0.98 if `stuck`
    double slip_angle_rad = 0.0;  ///< angle from the wheel planes to the direction of travel, left positive
    /// Energy of drives and hotel load per metre of surface along the direction of travel.
    double energy_J_per_m = 0.0;
    double speed_mps = 0.0;              ///< speed of travel along the surface
    double torque_Nm = 0.0;              ///< sum of the torques of all wheels
    std::vector<SimulatedWheel> wheels;  ///< states of the wheels, front wheels first
  };

  /// Returns the steady state of the rover for a motion.
  Step drive(const Motion& motion) const;
  /// Returns the energy and the time of a turn from heading `from` to the heading of `to`, at the position of
  /// `to` (terramech::turnEfforts()). The soil is that under the centre of the rover. Both values are 0 if
  /// `from` is (0, 0).
  terramech::TurnEffort turn(const costmap::Direction& from, const Motion& to) const;

  /// Returns the index in soils() of the soil at `place`. The radius of every patch is enlarged by
  /// `margin_m`.
  std::size_t soilAt(const maps::Point& place, double margin_m = 0.0) const noexcept;
  /// Returns true if `place` lies in a patch.
  bool inPatch(const maps::Point& place) const noexcept { return soilAt(place) >= classes_; }
  /// Returns the soils of the classes in order, then the distinct soils of the patches.
  const std::vector<terramech::Soil>& soils() const noexcept { return soils_; }
  /// Returns the effects that act on all soils.
  const std::vector<terramech::Effect>& effects() const noexcept { return effects_; }
  /// Returns the patches of the world; at an overlap the later patch counts.
  const std::vector<SoilPatch>& patches() const noexcept { return patches_; }

 private:
  struct Tables {
    SimulatedWheelTable fresh, rut;
  };

  std::vector<SimulatedWheel> standing(const Motion& motion) const;
  double strengthAt(const maps::Point& place) const noexcept;

  terramech::Rover rover_;
  maps::Raster<std::uint8_t> class_index_;
  std::size_t classes_;
  std::vector<terramech::Soil> soils_;
  std::vector<terramech::Effect> effects_;
  std::vector<std::optional<Tables>> tables_;  // of each soil that occurs in a cell or patch
  GroundDepartures departures_;
  std::vector<SoilPatch> patches_;
  std::vector<std::size_t> patch_soil_;  // of each patch
};

}  // namespace talus::planner
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

/// True soils of a site and their variation between worlds (random draws of the soils). Plain data.
struct Truth {
  /// True soils by class number, where they differ from the soils of the map.
  std::map<int, terramech::Soil> classes;
  std::vector<SoilPatch> patches;  ///< soil patches that are present in every world
  /// Relative standard deviation of cohesion, tangent of the friction angle and moduli [-].
  double spread = 0.0;
  /// True: the ground of each class departs from its soil as the map believes (GroundClass::mean_std and
  /// pull_std, correlation length of 5 m).
  bool as_believed = false;
  /// Number of random patches drawn per world; patches near start or goal are then omitted.
  int random_patches = 0;
  double patch_radius_m = 3.0;  ///< mean radius of random patches, > 0; radii are uniform within +-50 %
  terramech::Soil patch_soil;   ///< soil of the random patches, varied by `spread`
  std::vector<terramech::Effect> effects{};  ///< effects on all soils that the map does not declare
  bool second_slip = true;  ///< true: the rover measures a second slip by its speeds (SensorOptions)
};

/// Seed of the random draw of a world, and positions that stay free of random patches.
struct WorldDraw {
  std::uint64_t seed = 1;  ///< seed of the random draw
  maps::Point start;       ///< start of the drive, free of random patches [m]
  maps::Point goal;        ///< goal of the drive, free of random patches [m]
};

/// Returns the soils of one world on `grid`; the soils of terrain classes have the order of `classes`. Equal
/// draws give equal worlds. The soil of a class does not depend on the other classes, nor do the random
/// patches.
WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw);

/// Soil knowledge of the planner at the start of a drive.
enum class SoilKnowledge {
  Geometry,          ///< slopes and hazards only, with the same firm soil everywhere; telemetry is not used
  AlongOnly,         ///< the soils of the map, but no cost of driving across a slope; telemetry is not used
  Prior,             ///< the soils of the map; telemetry is not used
  OnLine,            ///< the soils of the map, updated by the telemetry of the drive
  PerfectKnowledge,  ///< the true soils, including all patches, and the true position; telemetry is not used
};

/// All values of SoilKnowledge in the order of the enumeration.
inline constexpr std::array kBeliefs{SoilKnowledge::Geometry, SoilKnowledge::AlongOnly, SoilKnowledge::Prior,
                                     SoilKnowledge::OnLine, SoilKnowledge::PerfectKnowledge};

/// Returns the name in function calls and JSON: "geometry", "along-only", "prior", "online", `"clairvoyant"`
/// (PerfectKnowledge).
std::string_view name(SoilKnowledge belief) noexcept;

/// Result of the drive in one world, that is, one random draw of the soils.
struct WorldResult {
  TraverseSimulation drive;            ///< the simulated drive
  std::size_t categories_changed = 0;  ///< number of cells with another category after the drive than before
};

/// Consecutive range of worlds for one soil knowledge.
struct WorldRange {
  SoilKnowledge belief = SoilKnowledge::OnLine;  ///< soil knowledge of the planner
  std::size_t first = 0;                         ///< index of the first world
  std::size_t count = 1;                         ///< number of worlds
};

/// Site of a simulation: a map, the true soils, and start and goal of a drive. The true soils are drawn at
/// random in any number of worlds. Immutable; safe to share between threads.
class SimulationSite {
 public:
  /// Input common to all worlds.
  struct Parts {
    Truth truth;              ///< true soils and their variation between worlds
    maps::Point start;        ///< start of the drive, map coordinates [m]
    maps::Point goal;         ///< goal of the drive, map coordinates [m]
    terramech::Soil firm;     ///< soil of all ground for SoilKnowledge::Geometry
    std::uint64_t seed = 1;   ///< the world with index i is drawn with the seed `seed` + i
    SensorOptions sensors{};  ///< sensors of the rover; their seed is replaced by the seed of the world
    std::function<Plan(const Problem&)> planner{};  ///< planner of every route; empty: FieldPlanner
  };

  /// `map` is the map of the site; it must outlive the object.
  SimulationSite(const costmap::TraversabilityMap& map, Parts parts);

  /// Simulates the drive in the world with index i for the soil knowledge `belief`. The result depends only
  /// on i and `belief`.
  WorldResult world(SoilKnowledge belief, std::size_t i, const ProgressMonitor& watch = {}) const;

  /// Returns the results of the worlds of `range` in order. The results do not depend on the division of the
  /// worlds into ranges. After a stop by `watch` the vector has fewer results.
  std::vector<WorldResult> worlds(const WorldRange& range, const ProgressMonitor& watch = {}) const;

  /// Returns the true soils of the world with index i.
  TrueWorld trueWorld(std::size_t i) const;
  /// Returns the map of the planner before the drive.
  costmap::TraversabilityMap estimatedMap(SoilKnowledge belief, const TrueWorld& world) const;
  /// Returns the parameters of the traverse simulation in the world with index i.
  SimulationOptions options(SoilKnowledge belief, std::size_t i) const;

 private:
  const costmap::TraversabilityMap& map_;
  Parts parts_;
};

/// Estimate of a quantity from a sample of worlds (random draws of the soils), with its 95 % confidence
/// interval.
struct Sampled {
  double value = 0.0;                   ///< estimate
  std::array<double, 2> interval_95{};  ///< lower and upper end of the interval
};

/// Returns the share hits / all with Wilson's interval (wilson_1927); NaN if `all` is 0.
Sampled share(std::size_t hits, std::size_t all);

/// Returns the mean of the values with the normal interval of its standard error; NaN if there are no values.
Sampled mean(const std::vector<double>& values);

/// Rates of the outcomes of drives in several worlds, and their mean energy.
struct Rates {
  std::size_t worlds = 0;            ///< number of worlds
  std::array<Sampled, 5> outcome{};  ///< share of each outcome, in the order of the enumeration Outcome
  double energy_J = 0.0;             ///< mean energy of the drives that reached the goal; NaN if no drive did
};

/// Returns the rates of the outcomes and the mean energy of `results`.
Rates ratesOf(const std::vector<WorldResult>& results);

/// Comparison of drives with a given soil knowledge and drives with perfect knowledge in the same worlds.
/// Only worlds with a safe route count, that is, worlds in which the drive with perfect knowledge reached the
/// goal.
struct Comparison {
  Rates rates;  ///< rates of the given soil knowledge over the worlds with a safe route
  /// Mean ratio of the energies, over worlds in which both drives reached the goal [-].
  Sampled energy_over_perfect_knowledge{};
};

/// Returns the comparison of `results` with `perfect`, the results with perfect knowledge. Both vectors
/// contain the same worlds in the same order. Throws std::invalid_argument if their sizes differ.
Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect);

/// Errors of the predictions of a map along a drive.
struct PredictionErrors {
  int steps = 0;           ///< number of steps of the drive
  double slip_rmse = 0.0;  ///< root mean square error of the predicted slip over all steps [-]
  /// Root mean square error of energy per metre, over the mean true energy per metre [-].
  double energy_rmse = 0.0;
  double energy_error = 0.0;  ///< (predicted - true) / true energy of the whole drive [-]
};

/// Log of the steps of a simulated drive. The function record() is called by SimulationOptions::on_step.
class TraverseLog {
 public:
  /// Appends a step.
  void record(const TraverseStep& step) { steps_.push_back(step); }

  /// Returns all recorded steps in order.
  const std::vector<TraverseStep>& steps() const noexcept { return steps_; }

  /// Returns the prediction errors over the recorded steps. The errors are 0 if there are no steps or if the
  /// true energy is not positive.
  PredictionErrors errors() const;

 private:
  std::vector<TraverseStep> steps_;
};

}  // namespace talus::planner
