#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/map/map_costs.hpp>
#include <talus/costmap/map/map_surface.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// The map of a site: surface with the hazards of each cell (MapSurface), wheel evidence (EvidenceField), and
/// the cost grid for planners (MapCosts). Only the members below change these parts. Memory: 15 bytes per
/// cell and about 60 bytes per block with evidence.
///
/// One thread changes a map: a concurrent call of learn(), forget(), refuse(), patch(), publish() or
/// publishAll() throws std::logic_error. published() may be called from any thread at any time without
/// waiting. Concurrent calls of other const members are safe while no thread changes the map.
class TraversabilityMap {
 public:
  struct Options {
    double footprint_radius_m =
        0.0;  ///< radius of the disc for slope and roughness; 0: half the diagonal of the rover's wheel base
    int threads = 1;  ///< >= 1; the result does not depend on the number of threads
  };

  /// Builds the map. Cells of a class without a soil are obstacles; cells outside the class raster are
  /// unknown. Throws std::invalid_argument if a layer has another grid or an invalid value.
  TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model, const Options& options,
                    const ProgressMonitor& watch = {});
  TraversabilityMap(TraversabilityMap&&) noexcept;
  ~TraversabilityMap();

  /// Elevation, classes, layers and hazards.
  const MapSurface& surface() const noexcept { return *surface_; }
  /// Evidence from wheel measurements.
  const EvidenceField& evidence() const noexcept { return field_; }
  /// Returns the cost grid and the categories of the cells.
  const MapCosts& costs() const noexcept { return *costs_; }

  const maps::Grid& grid() const noexcept { return surface_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return surface_->elevation(); }
  const GroundModel& model() const noexcept { return surface_->model(); }
  /// The newest published version.
  std::shared_ptr<const CostGrid> published() const noexcept { return costs_->published(); }

  /// Estimate of a cell inside the map, and of a floor of the cell; for many cells, use PlaceBeliefs.
  CellBelief belief(maps::Cell cell) const;
  CellBelief belief(maps::Cell cell, const Floor& floor) const;
  /// Strength of a cell's ground from the prior of the class and the evidence; nullopt for a cell without a
  /// class.
  std::optional<GroundBelief> ground(maps::Cell cell) const;

  /// Adds an observation; visible to planners after publish(). A cell with a known class accumulates evidence
  /// before its height is known, with the same result as in the reverse order. Evidence of danger on a cell
  /// without a class, or beyond the map's edge by less than the pose error, refuses the place like refuse():
  /// a block and two standard deviations of the pose around the place, independently of later patches.
  /// Returns false if the map has no ground at the place.
  bool learn(const WheelObservation& observation);
  /// Removes learned pulls and sinkages, as returned by evidence().readingsOf(), before their replacement.
  /// Bounds of the place remain. Visible to planners after publish().
  void forget(const SavedBlock& readings);
  /// Restores the evidence of a block from a file; visible to planners after publish(). Returns false if the
  /// map has no such block or class.
  bool restore(const SavedBlock& saved);

  /// Ids of the drives in the map (driveId()), sorted.
  const std::set<std::string>& drives() const noexcept { return drives_; }
  /// Records that a drive is in the map. `continued` is the id of the shorter drive that the drive replaces,
  /// if any.
  void noteDrive(const std::string& id, const std::string& continued = {}) {
    drives_.erase(continued);
    drives_.insert(id);
  }

  /// Declares the ground around a place impassable, for example after an immobilisation: Hazard::Obstacle on
  /// all cells whose centre lies within radius_m > 0. Visible to planners after publish(); stored in map
  /// files. Throws std::invalid_argument for a non-finite place or radius, or a radius <= 0.
  void refuse(const maps::Point& place, double radius_m);

  /// Replaces a window of the ground and publishes the window, with all learned evidence, as one new version.
  /// The new version equals a map that was built with these heights, rocks, classes and keep-out areas. Only
  /// cells whose footprint, clearance or wheel swath overlaps the window are measured again. Evidence stays
  /// assigned to the class for which the evidence was recorded. Throws std::invalid_argument with place and
  /// remedy for a patch of another resolution, outside the map, without an observation, or with an invalid
  /// value; the map is then unchanged.
  void patch(const SurfacePatch& patch);

  /// The map of a window shifted by `tiles` tiles of 64 cells eastward (columns) and northward (rows). The
  /// common area keeps its surface, evidence and refused places; new tiles are unseen. Equals a map built
  /// from the remaining data. The version number is that of this map plus 1. Throws std::invalid_argument if
  /// the windows do not overlap, or if a block of evidence is larger than a tile.
  TraversabilityMap moved(maps::Cell tiles, const ProgressMonitor& watch = {}) const;

  /// Publishes all changes since the last call as a new version: recomputes the cells whose ground changed,
  /// or where a wheel reaches changed ground, and shares unchanged tiles. Readers do not wait; a running
  /// planner keeps its version. If no index of a cost curve is free, all cells get new indices with coarser
  /// steps (GroundKind).
  ///
  /// The costs are bitwise equal to those of publishAll(), for any sequence of changes. A cell depends on its
  /// shape, on the class states in steps (ClassEvidence::stateInSteps()) and on the evidence within reach of
  /// its patch of blocks, and is recomputed after a change of any of these. Exception: after curve indices
  /// were exhausted, steps may be up to 8 times as coarse as those of publishAll(); no cost is lower.
  void publish();
  /// Recomputes and publishes all cells.
  void publishAll();

 private:
  bool refuseUnobserved(const WheelObservation& observation);

  std::shared_ptr<MapSurface> surface_;
  EvidenceField field_;
  std::unique_ptr<MapCosts> costs_;
  std::set<std::string> drives_;
  std::unique_ptr<std::atomic_flag> changing_;  // indirect, because std::atomic_flag is not movable
};

}  // namespace talus::costmap
