#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Estimated mean drawbar pull over load DP/W of one terrain class at slip 0.5, from the slips of a drive
/// (DrivePosterior) [-].
struct LearnedClass {
  int class_number = 0;     ///< number of the terrain class
  Estimate pull;            ///< DP/W over all hypotheses of the sensors (DrivePosterior)
  Estimate if_sound;        ///< DP/W for a sound slip sensor
  double counted_on = 0.0;  ///< DP/W used for decisions [-]
};

/// Counts and findings of one drive whose telemetry was added to a map.
struct DriveReport {
  std::size_t used = 0;  ///< number of rows that the map uses
  /// Number of used rows whose sensors are verified.
  std::size_t raising = 0;
  /// Number of rows rejected by the sensor checks, or whose position is not on the map.
  std::size_t rejected = 0;
  /// Number of rows of this drive that the map contained already; these rows are not counted again.
  std::size_t repeated = 0;
  std::size_t bounding = 0;  ///< number of rows that the file's reader rejected and that indicate danger
  /// Number of places without a terrain class that were declared impassable, because wheels indicated danger
  /// there.
  std::size_t unobserved = 0;
  /// Number of rows whose wheel or load differs from that of the map's rover; such rows count as unverified.
  std::size_t others = 0;
  std::string first_reason;           ///< reason of the first rejected row; empty without rejected rows
  std::vector<std::string> findings;  ///< results of the sensor checks, one line each
  /// One entry for each terrain class driven on; empty if no row is verified.
  std::vector<LearnedClass> learned;
  double slip_offset = 0.0;  ///< estimated offset of the slip sensor: its reading at zero slip [-]
  /// Estimated scale of the slip sensor: change of the reading per change of slip [-].
  double slip_scale = 1.0;
};

/// Options for adding telemetry, and default values for missing columns.
struct IntakeOptions {
  double pose_std_m = 0.5;  ///< standard deviation of positions if the file has no column pose_std_m
  /// True if a DriveIntake stores its rows for settle(); one row takes about 400 bytes.
  bool settles = false;
};

/// Adds the telemetry of one drive to a map in parts, while the telemetry is received. The state of the
/// sensor checks is kept from one part to the next. A part must contain whole moments, i.e. the rows of all
/// wheels at one time. The posterior of the drive is estimated from 32 moments on and again after each increase
/// by a quarter, whereas addDrive() evaluates the whole drive first. Until settle() is called, rows before the
/// first estimate count as unverified, and an estimate may be higher or lower than that of addDrive(). Planners use the result after map.publish(). Not thread-safe.
class DriveIntake {
 public:
  /// Keeps references to `map` and `journal`. `journal` stores all rows; it may be null.
  explicit DriveIntake(TraversabilityMap& map, EvidenceJournal* journal = nullptr,
                       const IntakeOptions& options = {});
  ~DriveIntake();
  DriveIntake(const DriveIntake&) = delete;
  DriveIntake& operator=(const DriveIntake&) = delete;

  /// Adds one part of the telemetry. Required columns and exceptions are those of addDrive().
  void add(const terramech::Telemetry& telemetry);
  /// Evaluates all rows so far again, with the sensor checks of all rows, and replaces the evidence of the
  /// parts in the map and the journal. The result is bit-identical to that of addDrive() for the same rows,
  /// and takes as long. Throws std::logic_error unless IntakeOptions::settles is true.
  void settle();
  /// Returns the counts and findings of all parts so far.
  DriveReport report() const;

 private:
  friend DriveReport addDrive(TraversabilityMap&, const terramech::Telemetry&, EvidenceJournal*,
                              const IntakeOptions&);
  struct State;
  std::unique_ptr<State> state_;
};

/// Adds the rows of a telemetry file to a map, in the order of the file, and publishes the whole map. The map
/// therefore depends only on the evidence and not on its division into files. A drive that the map already
/// contains is not added again; if the file grew since, only the new rows are added. Required columns: x_m,
/// y_m, load_N, slip. Optional columns: torque_Nm, sinkage_m, slope_rad, drawbar_pull_N, heading_rad, time_s,
/// pass_index, z_m, pose_std_m, and for a second slip rim_speed_mps or wheel_rate_rad_s, and speed_mps or
/// odometry_x_m and odometry_y_m. Without slope_rad, the slope of the map along the heading is used. If
/// `journal` is not null, all rows are stored in the journal in one transaction. Throws InputError if a
/// required column is missing.
///
/// Suspected readings, and rows that the file's reader rejected, are used only if they indicate danger
/// (DangerWatch), and only for the ground where the reading was taken. DrivePosterior corrects the others.
DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry,
                     EvidenceJournal* journal = nullptr, const IntakeOptions& options = {});

/// Adds to a map each drive of a journal that the map does not contain and `without` does not name, and publishes
/// the map. The same drives in any order, of one journal or of several, give a bit-identical map. Drives that the map contains are compared with the journal; one
/// finding counts the drives of the map that the journal lacks. Throws InputError for a damaged journal; the
/// map then contains the drives before the damage.
DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal,
                   const std::set<std::string>& without = {});

}  // namespace talus::costmap
