#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/map/map_costs.hpp>
#include <talus/costmap/map/map_surface.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

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

}  // namespace talus::costmap
