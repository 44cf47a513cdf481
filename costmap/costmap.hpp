#pragma once

/// Umbrella header of talus::costmap: includes the traversability map, learning from wheel measurements, and
/// map files.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Options for measuring the terrain shape of cells.
struct ShapeOptions {
  /// Radius of the disc of cells over which slope and roughness are measured, > 0.
  double footprint_radius_m = 0.0;
  int threads = 1;  ///< number of threads, >= 1; the result does not depend on this number
};

/// Surface of a map: elevation, terrain classes, cost layers, and the hazards of each cell, including ground
/// declared impassable. The surface is independent of evidence and cost. Concurrent const calls are safe
/// while no thread changes the surface; only the map changes the surface.
class MapSurface {
 public:
  /// Makes the surface from `layers`. Hazards are computed later, by measure(). Throws std::invalid_argument
  /// if a layer has another grid than the elevation, or an invalid value.
  MapSurface(MapLayers layers, std::shared_ptr<const GroundModel> model, const ShapeOptions& options);

  const maps::Grid& grid() const noexcept { return site_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return site_->elevation; }
  const GroundModel& model() const noexcept { return *site_->model; }
  /// Returns elevation, terrain classes and layers, which the map shares with its evidence.
  std::shared_ptr<const GroundSite> site() const noexcept { return site_; }
  const SurfaceKeys& keys() const noexcept { return site_->keys; }

  const maps::Raster<std::uint8_t>& classes() const noexcept { return site_->classes; }
  /// Returns the terrain-class number of a cell; 0 without a class raster.
  int classNumber(maps::Cell cell) const noexcept {
    return site_->classes.empty() ? 0 : site_->classes[cell];
  }
  /// Returns the index of the cell's terrain class in model().parts().classes; -1 for a class without a soil.
  int classIndex(maps::Cell cell) const noexcept { return site_->classIndex(cell); }
  const std::vector<CostLayer>& costLayers() const noexcept { return site_->costs; }

  const maps::Raster<Hazard>& hazards() const noexcept { return hazards_; }
  Hazard hazards(maps::Cell cell) const noexcept { return hazards_[cell]; }
  const HazardLimits& limits() const noexcept { return limits_; }
  /// Returns the hazards by rocks, keep-out areas and ground declared impassable, without the clearance
  /// around them (Hazard::Near); empty if the map contains none of these hazards.
  const maps::Raster<Hazard>& declared() const noexcept { return declared_; }
  /// Returns the places declared impassable, in the order of their declaration.
  const std::vector<RefusedPlace>& refused() const noexcept { return refused_; }

  double footprintRadius_m() const noexcept { return options_.footprint_radius_m; }
  int threads() const noexcept { return options_.threads; }
  /// Returns the options of maps::terrainMetrics() for `threads` threads (>= 1).
  maps::FootprintOptions footprint(int threads) const noexcept {
    return {
        .radius_m = options_.footprint_radius_m, .step_span_m = limits_.wheel_diameter_m, .threads = threads};
  }

  /// Callback with a cell and its code. The code has the gradients of the fitted plane, and no cost curve.
  using TakeShape = std::function<void(maps::Cell, CellCode)>;
  /// Measures the whole surface: computes the hazards of all cells, and calls `take` with the gradients of
  /// each cell.
  void measure(const TakeShape& take, const ProgressMonitor& watch);

  /// Gradients of the cells of `box`: `codes` has one cell code for each cell of the box. The codes have no
  /// cost curve.
  struct Gradients {
    maps::CellBox box;
    maps::Raster<CellCode> codes;
  };
  /// Cells that a patch (new observation of a window of the ground) changed.
  struct PatchEffect {
    maps::CellBox window;  ///< box of cells that the patch covers
    maps::CellBox judged;  ///< box of cells whose hazards or gradients may have changed
    Gradients gradients;   ///< gradients of the cells that were measured again
  };
  /// Replaces the surface in the window of a patch, and measures all affected cells again. Throws
  /// std::invalid_argument, with location and remedy, for an invalid patch; the surface is then unchanged.
  PatchEffect take(const SurfacePatch& patch);

  /// Marks the cells of a place as obstacles (impassable), and returns the bounding box of these cells.
  maps::CellBox refuse(const RefusedPlace& place);
  /// Removes the places that the wheels of a drive declared, and returns their bounding boxes.
  std::vector<maps::CellBox> leaveOut(std::uint16_t drive);

 private:
  // Cell code (gradients and index of the cost curve) and hazards of a measured cell.
  struct Ground {
    CellCode code;
    Hazard hazards;
  };
  Ground grounded(maps::Cell cell, const GroundShape& shape, Hazard found) const;
  maps::CellBox mark(const RefusedPlace& refusal, bool refused);
  void takeHazards(const SurfacePatch& patch, const maps::CellBox& window);
  void takeGround(const SurfacePatch& patch, const maps::CellBox& window);
  Hazard layerHazards(maps::Cell cell) const;
  Hazard rocksOn(float abundance) const;
  Hazard spreading() const noexcept;

  std::shared_ptr<GroundSite> site_;
  HazardLimits limits_;
  ShapeOptions options_;
  bool any_height_ = false;
  maps::Raster<Hazard> declared_;  // hazards by layers other than elevation and terrain classes
  maps::Raster<Hazard> hazards_;
  std::vector<RefusedPlace> refused_;
};

class EvidenceField;
class GroundCurves;
class PublishedGrid;

/// Number of cells of each category. Refused cells with a hazard count as dangerous, unobserved cells as
/// unknown.
struct CategoryCounts {
  std::size_t safe = 0, marginal = 0, dangerous = 0, unknown = 0;
};

/// The published cost grid of a map, and the changes since its newest version. published() may be called from
/// any thread at any time; other const members may be called while no thread changes the map. Only the map
/// calls non-const members.
class MapCosts {
 public:
  /// Measures the surface and publishes version 1 of the cost grid, without evidence from wheels.
  MapCosts(std::shared_ptr<MapSurface> surface, const ProgressMonitor& watch);
  ~MapCosts();

  /// Returns the newest version of the cost grid.
  std::shared_ptr<const CostGrid> published() const noexcept;

  /// Returns the estimated strength of ground from which the published cost of a cell follows, after
  /// WheelSwath combined the ground under all wheels and after rounding (rounded()); nullopt for blocked
  /// and unknown cells.
  std::optional<GroundBelief> ground(maps::Cell cell) const;
  /// Returns the published category of a cell; nullopt for blocked and unknown cells.
  std::optional<CellCategory> ranked(maps::Cell cell) const;
  /// Return the published category of a cell, or of all, as numbers (terramech::Category); blocked cells are
  /// dangerous.
  std::uint8_t category(maps::Cell cell) const noexcept { return categoryOf(*published(), cell); }
  maps::Raster<std::uint8_t> categories() const;
  CategoryCounts countCategories() const;
  /// Returns the number of cells whose cost differs from that of an earlier version.
  std::size_t cellsChanged(const CostGrid& before) const;

  /// Mark the cells of a box as possibly different from the newest version: noteLearned() for cells with a
  /// changed estimate, noteChanged() for cells with changed hazards or terrain class.
  void noteLearned(const maps::CellBox& box);
  void noteChanged(const maps::CellBox& box) { changed_.push_back(box); }
  /// Marks the changes of a patch (new observation of a window of the ground). `classes` is true if the patch
  /// has terrain classes.
  void notePatched(MapSurface::PatchEffect effect, bool classes);

  /// Publishes the marked changes as a new version (TraversabilityMap::publish()).
  void publish(const EvidenceField& field);
  /// Recomputes the cost of all cells and publishes a new version.
  void publishAll(const EvidenceField& field);
  /// Publishes the newest version under another version number.
  void republishAs(std::uint64_t version);

 private:
  std::uint8_t categoryOf(const CostGrid& grid, maps::Cell cell) const noexcept;
  std::shared_ptr<const CostGrid> measured(const ProgressMonitor& watch);
  CellCode coded(maps::Cell cell, CellCode code);
  void publish(const EvidenceField& field, bool whole);
  std::shared_ptr<const CostGrid> costed(const std::vector<maps::CellBox>& changed);
  std::shared_ptr<const CostGrid> rewritten(const std::vector<maps::CellBox>& ranges);

  std::shared_ptr<MapSurface> surface_;
  std::unique_ptr<GroundCurves> curves_;
  std::unique_ptr<PublishedGrid> published_;
  std::size_t most_curves_;                         // number above which former curves are discarded
  std::vector<maps::CellBox> learned_, changed_;    // changes since the newest version
  std::optional<MapSurface::Gradients> gradients_;  // gradients of the next version
  std::optional<HeightTable> heights_m_;            // elevations of the next version, for the whole map
};

/// Shift of the window that a map covers, by whole tiles (blocks of 64x64 cells): tiles are dropped at one
/// side, and unobserved tiles are added at the other side. Immutable.
class MapShift {
 public:
  /// Makes the shift of `grid` by `tiles` tiles eastward (columns) and northward (rows). Blocks of evidence
  /// have block_cells cells per side. Throws std::invalid_argument if the new window does not overlap the old
  /// window, or if a block is larger than a tile.
  MapShift(const maps::Grid& grid, maps::Cell tiles, int block_cells);

  /// Returns the layers of a surface on the new window; unobserved cells are NaN, or have no class and no
  /// hazard.
  MapLayers layers(const MapSurface& surface) const;
  /// Returns the evidence block `saved` with its position in the new window; the position may be outside the
  /// window.
  SavedBlock block(SavedBlock saved) const;

 private:
  template <typename T>
  maps::Raster<T> shifted(const maps::Raster<T>& old, T unseen) const;

  maps::Cell cells_;
  maps::Grid grid_;  // grid of the new window
  int block_cells_;
};

/// The traversability map of a site. It consists of the surface with the hazards of each cell (MapSurface),
/// the evidence from wheel measurements (EvidenceField), and the cost grid for planners (MapCosts). Only
/// members of this class change these parts. Memory: 15 bytes per cell, and about 60 bytes per block with
/// evidence. A block is a square of cells that stores its evidence together (BlockGrid).
///
/// Only one thread may change a map: a concurrent call of learn(), forget(), refuse(), patch(), publish() or
/// publishAll() throws std::logic_error. published() may be called from any thread at any time and does not
/// wait. Concurrent calls of other const members are safe while no thread changes the map.
class TraversabilityMap {
 public:
  struct Options {
    /// Radius of the disc over which slope and roughness of a cell are measured [m]; 0: half the diagonal of
    /// the rover's wheel base.
    double footprint_radius_m = 0.0;
    int threads = 1;  ///< number of threads, >= 1; the result does not depend on this number
  };

  /// Builds the map and publishes version 1. Cells whose terrain class has no soil in `model` are obstacles.
  /// If `layers` has a class raster, cells without a class number are unknown ground. Throws
  /// std::invalid_argument if a layer has another grid than the elevation, or an invalid value.
  TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model, const Options& options,
                    const ProgressMonitor& watch = {});
  TraversabilityMap(TraversabilityMap&&) noexcept;
  TraversabilityMap& operator=(TraversabilityMap&&) noexcept;
  ~TraversabilityMap();

  /// Returns the surface: elevation, terrain classes, layers and hazards.
  const MapSurface& surface() const noexcept { return *surface_; }
  /// Returns the evidence from wheel measurements.
  const EvidenceField& evidence() const noexcept { return field_; }
  /// Returns the cost grid and the categories of the cells.
  const MapCosts& costs() const noexcept { return *costs_; }

  const maps::Grid& grid() const noexcept { return surface_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return surface_->elevation(); }
  const GroundModel& model() const noexcept { return surface_->model(); }
  /// Returns the newest published version of the cost grid.
  std::shared_ptr<const CostGrid> published() const noexcept { return costs_->published(); }

  /// Returns the estimate (soil strength, category, hazards) of a cell inside the map. PlaceBeliefs is faster
  /// for many cells.
  CellBelief belief(maps::Cell cell) const;
  /// Returns the estimated strength of a cell's ground, from the prior of the terrain class and the evidence;
  /// nullopt for a cell without a terrain class.
  std::optional<GroundBelief> ground(maps::Cell cell) const;

  /// Adds a wheel observation to the evidence. Planners use the observation after publish(). A cell with a
  /// known class accumulates evidence before its elevation is known, with the same result as in the reverse
  /// order. Evidence of danger on a cell without a class, or beyond the map's edge by less than the pose
  /// error, declares the place impassable, like refuse(): within a block side plus two standard deviations of
  /// the position, independently of later patches. Returns false if the map has no ground at the position of
  /// the observation.
  bool learn(const WheelObservation& observation);
  /// Removes readings that learn() stored, e.g. to replace them. `readings` is of evidence().readingsOf().
  /// Planners use the change after publish().
  void forget(const SavedBlock& readings);
  /// Adds the evidence of one block that was read from a file. Planners use the evidence after publish().
  /// Returns false if the map has no such block or terrain class.
  bool restore(const SavedBlock& saved);

  /// What a map records of a drive.
  struct Drive {
    std::uint16_t number = 0;  ///< number of its readings (WheelObservation::drive); 0: unknown
    std::string sensors{};     ///< what its sensors were found to be, as text
  };
  /// Returns the drives whose telemetry the map contains, by identifier (DriveId).
  const std::map<std::string, Drive>& drives() const noexcept { return drives_; }
  /// Records that the map contains the drive `id`. `continued` is the identifier of the shorter drive that
  /// `id` replaces; empty: `id` replaces no drive.
  void noteDrive(const std::string& id, const Drive& drive, const std::string& continued = {}) {
    drives_.erase(continued);
    drives_[id] = drive;
  }
  /// Removes all evidence of a drive, and of its further parts: of all drives with its number. Planners use the
  /// change after publish(). The map equals one that never contained the drive, except that the time and the
  /// position uncertainty of a block remain the greatest of all its readings. Throws std::invalid_argument if
  /// the map lacks the drive or its number.
  void leaveOut(const std::string& id);

  /// Declares the ground around a place impassable, for example after an immobilisation: all cells whose
  /// centre lies within radius_m > 0 [m] of `place` become Hazard::Obstacle. Planners use the change after
  /// publish(). Map files store the declaration. Throws std::invalid_argument for a non-finite place or
  /// radius, or a radius <= 0.
  /// `drive` is the number of the drive that declared the place; 0: none.
  void refuse(const maps::Point& place, double radius_m, std::uint16_t drive = 0);

  /// Replaces the ground of a window (rectangle of cells) by a new observation, and publishes the change and
  /// all learned evidence as one new version. The new version equals a map that was built with these
  /// elevations, rocks, terrain classes and keep-out areas. Only cells whose footprint, clearance or wheel
  /// swath overlaps the window are measured again. Evidence stays assigned to the terrain class for which the
  /// evidence was recorded. Throws std::invalid_argument, with location and remedy, if the patch has another
  /// resolution, lies outside the map, has no observation, or has an invalid value; the map is then
  /// unchanged.
  void patch(const SurfacePatch& patch);

  /// Returns the map of a window that is shifted by `tiles` tiles of 64 cells eastward (columns) and
  /// northward (rows). The area common to both windows keeps its surface, evidence and places declared
  /// impassable; the cells of new tiles are unobserved. The result equals a map built from the remaining
  /// data. Its version number is that of this map plus 1. Throws std::invalid_argument if the windows do not
  /// overlap, or if a block of evidence is larger than a tile.
  TraversabilityMap moved(maps::Cell tiles, const ProgressMonitor& watch = {}) const;

  /// Publishes all changes since the last call as a new version of the cost grid. Recomputes the cells whose
  /// ground changed and the cells from which a wheel reaches changed ground. Tiles (64x64 cells) without such
  /// cells are shared with the previous version. Readers do not wait, and a running planner keeps its
  /// version.
  ///
  /// The costs are bit-identical to those of publishAll(), for any sequence of changes. A cell depends on its
  /// shape, on the rounded state of the terrain classes (ClassEvidence::stateInSteps()) and on the evidence
  /// within reach of its patch of 8x8 blocks, and is recomputed after a change of any of these.
  void publish();
  /// Recomputes the cost of all cells and publishes a new version.
  void publishAll();

 private:
  bool refuseUnobserved(const WheelObservation& observation);

  std::shared_ptr<MapSurface> surface_;
  EvidenceField field_;
  std::unique_ptr<MapCosts> costs_;
  std::map<std::string, Drive> drives_;
  // allocated separately, because std::atomic_flag is not movable
  std::unique_ptr<std::atomic_flag> changing_;
};

/// A quantity on which the category of a cell depends.
struct Cause {
  std::string name;    ///< name with the unit as suffix, e.g. "slope_rad"
  double value = 0.0;  ///< value of the quantity, in the unit of the suffix of `name`
  double std = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of `value`; NaN: unknown
  std::string source;  ///< origin of `value`, e.g. the elevation map or the prior
  std::string remark;  ///< effect of the quantity on the category; may be empty
};

/// The category of a cell (safe, marginal, dangerous or unknown), with the quantities that determine the
/// category.
struct Explanation {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;  ///< probability of `category`, 0 to 1; NaN for Unknown
  std::string verdict;       ///< summary in one line
  std::vector<Cause> causes;
};

/// Returns the category of a cell for driving in one heading, with its causes. `cell` must lie inside the
/// map. Without `heading`, the heading of worstHeading() is used.
Explanation explain(const TraversabilityMap& map, maps::Cell cell,
                    const std::optional<Direction>& heading = std::nullopt);

/// The place where one drive is expected to tell most about the ground around another place.
struct NextDrive {
  maps::Cell cell;
  Direction heading;              ///< heading in which a reading is most accurate
  std::size_t cells = 0;          ///< number of blocks of ground around that are refused or uncertain
  double std = 0.0, after = 0.0;  ///< their mean standard deviation of DP/W, before and after a reading [-]
};

/// Returns the allowed place within three correlation lengths of `around` at which a reading is expected to reduce
/// most the variance of ground that is not safe in every heading; nullopt without such ground or such places.
/// With the standard deviations s of the estimates, the variance c^2 of the class mean, that of places p^2, and the
/// error e of a reading (B4), a reading at a is expected to reduce the variance at x by
///   cov^2/(s_a^2 + e^2),  cov = min(c^2 + p^2 k(d), s_a s_x)                                      (ours)
/// Whether the rover can reach the place is not checked.
std::optional<NextDrive> nextDrive(const TraversabilityMap& map, maps::Cell around);

/// Returns an OctoMap octree with the estimate of each cell of the map, at the cell's elevation.
TraversabilityTree treeOf(const TraversabilityMap& map);

/// Writes the octree of treeOf() without storing it in memory. The stream must be seekable.
void writeTree(const TraversabilityMap& map, std::ostream& stream);

/// Writes a map in the format MAP.ot: an OctoMap file of type TraversabilityTree, followed by a trailer.
/// Other programs stop reading after the tree nodes. The trailer contains the grid, coordinate system, rover,
/// soils, policy, elevation, terrain classes, declared hazards, evidence, drives, cost layers and a checksum
/// of the whole file. docs/map_file.md specifies the layout. Numbers are little-endian; equal maps give equal
/// bytes. The stream must be empty and readable.
void writeMap(const TraversabilityMap& map, std::iostream& stream);

/// Writes the map to the file `path`. The file is replaced atomically (OutputFile). Throws InputError if the
/// file cannot be written.
void writeMap(const TraversabilityMap& map, const std::string& path);

/// Options for reading a map.
struct MapReading {
  std::string name;  ///< path of the file; names the file or stream in error messages
  int threads = 1;   ///< number of threads, >= 1
  /// Makes the georeference (conversion to latitude and longitude) from a coordinate system and a grid. The
  /// default uses GeographicLib and provides no latitude and longitude for coordinate systems that need PROJ
  /// (maps::ElevationMap::places). talus::maps_io provides a function that uses PROJ.
  std::function<maps::Georeference(const maps::CoordinateSystem&, const maps::Grid&)> georeference{};
};

/// Returns the map that a seekable stream contains, with its cost grid. `watch` receives the progress. Throws
/// InputError if the stream is truncated, damaged, or not a map.
TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const ProgressMonitor& watch = {});

/// Returns the map that the file `reading.name` or `path` contains. Throws InputError also if the file cannot
/// be opened.
TraversabilityMap readMap(const MapReading& reading, const ProgressMonitor& watch = {});
TraversabilityMap readMap(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});

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
  /// Number of rows with another wheel or load than the map's rover has; such rows count as unverified.
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
  /// Moves the window of the map (TraversabilityMap::moved()); the drive goes on.
  void move(maps::Cell tiles);
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
