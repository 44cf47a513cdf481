#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Mean drawbar pull over load of one class at slip 0.5 from the slips of a drive (SlipFit) [-].
struct LearnedClass {
  int class_number = 0;     ///< number of the terrain class
  Estimate pull;            ///< with the offset and scale of the slip sensor estimated
  Estimate if_sound;        ///< for a sensor with offset 0.03 and scale error 5 % (standard deviations)
  double counted_on = 0.0;  ///< value used for decisions [-]
};

/// Result of adding a drive to a map.
struct DriveReport {
  std::size_t used = 0;      ///< rows that the map uses
  std::size_t raising = 0;   ///< used rows that may raise an estimate, with verified sensors
  std::size_t rejected = 0;  ///< rows rejected by the sensor checks, or without a place on the map
  std::size_t repeated = 0;  ///< rows of this drive that the map contains already; not counted again
  std::size_t bounding = 0;  ///< rows that the file's reader rejected and that indicate danger
  std::size_t unobserved =
      0;                     ///< refused places without a terrain class in the map, at which wheels indicated
                             ///< danger
  std::size_t others = 0;    ///< rows of a wheel or load other than the map's rover; such rows raise no
                             ///< estimate
  std::string first_reason;  ///< reason of the first rejected row; empty without rejected rows
  std::vector<std::string> findings;  ///< results of the sensor checks, one line each
  std::vector<LearnedClass> learned;  ///< one for each class driven on; empty if no row may raise an estimate
  double slip_offset = 0.0;           ///< offset of the slip sensor, from its rows [-]
  double slip_scale = 1.0;            ///< scale of the slip sensor, from its rows [-]
};

/// Options for adding telemetry, and defaults for columns that a file may lack.
struct IntakeOptions {
  double pose_std_m = 0.5;  ///< standard deviation of positions if the file has no column pose_std_m
  /// True if a DriveIntake stores its rows, about 400 bytes each, for settle().
  bool settles = false;
};

/// Identifier of a drive: a checksum of the values that maps use, as 16 hexadecimal digits. File name, order
/// of columns and other columns have no effect.
std::string driveId(const terramech::Telemetry& telemetry);

/// Adds telemetry to a map in parts, while the telemetry is received. The state of the sensor checks is kept
/// from one part to the next. A part contains whole moments: all wheels at one time. The verification of a
/// sensor takes effect from the next row on, and a bias of torque or sinkage from the next part on, whereas
/// addDrive() evaluates the whole drive first. Until settle(), rows before a verification only lower
/// estimates, and estimates may differ from those of addDrive() in either direction. Planners use the result
/// after map.publish(). Not thread-safe.
class DriveIntake {
 public:
  /// Keeps references to both arguments; `journal` may be null.
  explicit DriveIntake(TraversabilityMap& map, EvidenceJournal* journal = nullptr,
                       const IntakeOptions& options = {});
  ~DriveIntake();
  DriveIntake(const DriveIntake&) = delete;
  DriveIntake& operator=(const DriveIntake&) = delete;

  /// Adds one part. Columns and errors as addDrive().
  void add(const terramech::Telemetry& telemetry);
  /// Evaluates all rows so far again, with the sensor checks of all rows, and replaces the evidence of the
  /// parts in the map and the journal: the result is bitwise equal to that of addDrive() for the same rows.
  /// Takes as long as addDrive(). Throws std::logic_error unless IntakeOptions::settles is true.
  void settle();
  /// Report of all parts so far.
  DriveReport report() const;

 private:
  friend DriveReport addDrive(TraversabilityMap&, const terramech::Telemetry&, EvidenceJournal*,
                              const IntakeOptions&);
  struct State;
  std::unique_ptr<State> state_;
};

/// Adds the rows of a telemetry file to a map, in their order, and publishes the whole map, so that the map
/// depends only on the evidence and not on its division into files. A drive that the map contains already is
/// not added again; of a file that grew since, only the new rows are added. Required columns: x_m, y_m,
/// load_N, slip. Optional columns: torque_Nm, sinkage_m, slope_rad, drawbar_pull_N, heading_rad, time_s,
/// pass_index, z_m, pose_std_m. Without slope_rad the slope of the map along the heading is used. All rows
/// are stored in the journal, if given, in one transaction. Throws InputError if a required column is
/// missing.
///
/// Suspected readings, and rows that the file's reader rejected, are used only if they indicate danger
/// (DangerWatch), and only for their place. SensorProof decides which readings may raise an estimate;
/// SensorProof requires heading_rad, slope_rad and varying slopes.
DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry,
                     EvidenceJournal* journal = nullptr, const IntakeOptions& options = {});

/// Adds each drive of a journal that the map does not contain, and publishes: the same map and journal give a
/// bitwise equal map. Drives that the map contains are verified in the journal; one finding counts the drives
/// that the journal lacks. Throws InputError for a damaged journal; the map then contains the drives before
/// the damage.
DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal);

}  // namespace talus::costmap
