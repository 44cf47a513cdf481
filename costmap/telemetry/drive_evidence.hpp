#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// What the slips of a drive say of the ground of one class, on average (SlipFit): drawbar pull over load at slip 0.5 [-].
struct LearnedClass {
  int class_number = 0;
  Estimate pull;            ///< whatever the slip sensor's offset and scale
  Estimate if_sound;        ///< of a sensor that is off by 0.03 and 5 % (standard deviations)
  double counted_on = 0.0;  ///< by decisions
};

/// What putting a drive into a map came to.
struct DriveReport {
  std::size_t used = 0;
  std::size_t raising = 0;   ///< of those, what may raise a belief: by sensors that proved sound
  std::size_t rejected = 0;  ///< by the sensors' watch, or without a place on the map
  std::size_t repeated = 0;  ///< rows that the map holds already, all or the first of a drive: counted once
  std::size_t heard = 0;     ///< rows that the file's reader rejected, yet point to danger
  std::size_t unobserved =
      0;  ///< places refused, since wheels point to danger where the map has no terrain class
  std::size_t others = 0;    ///< rows of another wheel or load than the map's rover's: they raise nothing
  std::string first_reason;  ///< of the first row rejected; empty when none was
  std::vector<std::string> findings;  ///< what the sensors' watch saw, a line each
  std::vector<LearnedClass> learned;  ///< of the classes driven; none where nothing may raise
  double slip_offset = 0.0;           ///< of the slip sensor, as its rows show it [-]
  double slip_scale = 1.0;            ///< likewise
};

/// What a telemetry file does not say about itself.
struct IntakeOptions {
  double pose_std_m =
      0.5;  ///< how well places are known where there is no column pose_std_m, one standard deviation
  /// Whether a DriveIntake keeps its rows, of some 400 bytes each, so that it can settle().
  bool settles = false;
};

/// The id of a drive: a checksum of what maps learn from in its rows as 16 hexadecimal digits, whatever the file is called,
/// in whatever order its columns are and whatever others there are.
std::string driveId(const terramech::Telemetry& telemetry);

/// Puts telemetry into a map while it comes in, part by part: what the sensors' watch knows is kept from one
/// part to the next. A part holds whole moments: all wheels that were read at one time. Where addDrive() sees
/// a whole drive first, here what proves a sensor counts from the row after it shows, and a bias of torque or sinkage from the
/// part after: rows before that only lower, and estimates may lie on either side of addDrive()'s. settle() makes them the same.
/// Planners see what was learned after map.publish(). Not thread-safe.
class DriveIntake {
 public:
  /// Both are kept by reference; `journal` may be null.
  explicit DriveIntake(TraversabilityMap& map, EvidenceJournal* journal = nullptr,
                       const IntakeOptions& options = {});
  ~DriveIntake();
  DriveIntake(const DriveIntake&) = delete;
  DriveIntake& operator=(const DriveIntake&) = delete;

  /// Columns and errors as addDrive().
  void add(const terramech::Telemetry& telemetry);
  /// Judges all rows so far again by what all of them say of the sensors, and puts what they teach then in the place of what
  /// each part taught, in the map and the journal: to the bit what addDrive() learns of the same rows. It takes as long as
  /// addDrive(). Throws std::logic_error unless IntakeOptions::settles.
  void settle();
  /// Of all parts so far.
  DriveReport report() const;

 private:
  friend DriveReport addDrive(TraversabilityMap&, const terramech::Telemetry&, EvidenceJournal*,
                              const IntakeOptions&);
  struct State;
  std::unique_ptr<State> state_;
};

/// Puts the rows of a telemetry file into a map, in their order, and publishes all of it anew, so
/// that the map depends on the evidence alone and not on how it was divided. A drive that the map holds already changes
/// nothing; of a file that grew since, the rows behind those that the map holds are put in. Columns x_m, y_m, load_N and
/// slip must be there; torque_Nm, sinkage_m, slope_rad, drawbar_pull_N, heading_rad, time_s,
/// pass_index, z_m, pose_std_m help. The slope is the row's own; without it the map's along the heading. All rows
/// go into the journal, if there is one, in one transaction. Throws InputError when a column is missing.
///
/// A reading that the sensors' watch suspects, and a row that the file's reader rejected, count all the same where they
/// point to danger (DangerWatch), though of no other place. What may raise is what SensorProof allows; it takes heading_rad, slope_rad and slopes that vary.
DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry,
                     EvidenceJournal* journal = nullptr, const IntakeOptions& options = {});

/// Puts every drive of a journal that a map does not hold into it and publishes: same map before, same journal, same map
/// after, to the bit. Drives that the map holds are checked in the journal, and one finding counts those that the journal
/// lacks. Throws InputError for a damaged journal, and leaves the map with the drives before the damage.
DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal);

}  // namespace talus::costmap
