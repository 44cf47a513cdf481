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

/// The map of a site, made of three parts: its surface with the hazards of each cell (MapSurface), the evidence of wheels
/// (EvidenceField), and the cost grid that planners read (MapCosts). The map alone changes them, through the members below.
/// Fifteen bytes a cell and some sixty a block that was driven.
///
/// One thread changes a map: a second that calls learn(), forget(), refuse(), patch() or publish() meanwhile gets a
/// std::logic_error. published() may be called from any thread at any time and never waits. Other const members may be
/// called from several threads while none changes the map.
class TraversabilityMap {
 public:
  struct Options {
    double footprint_radius_m =
        0.0;          ///< disc that slope and roughness are measured over; 0: half the rover's diagonal
    int threads = 1;  ///< >= 1; the result does not depend on it
  };

  /// Builds the map. Cells of a class without a soil count as obstacles, cells that the class raster leaves
  /// out as unknown. Throws std::invalid_argument when a layer lies on another grid.
  TraversabilityMap(MapLayers layers, std::shared_ptr<const GroundModel> model, const Options& options,
                    const ProgressMonitor& watch = {});
  TraversabilityMap(TraversabilityMap&&) noexcept;
  ~TraversabilityMap();

  /// Elevation, classes, layers and hazards.
  const MapSurface& surface() const noexcept { return *surface_; }
  /// What the wheels measured so far.
  const EvidenceField& evidence() const noexcept { return field_; }
  /// The cost grid and the categories that follow from it.
  const MapCosts& costs() const noexcept { return *costs_; }

  const maps::Grid& grid() const noexcept { return surface_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return surface_->elevation(); }
  const GroundModel& model() const noexcept { return surface_->model(); }
  /// The newest published version, for planners to pin.
  std::shared_ptr<const CostGrid> published() const noexcept { return costs_->published(); }

  /// The estimate of a cell inside the map, and of its floor; for many cells in a row see PlaceBeliefs.
  CellBelief belief(maps::Cell cell) const;
  CellBelief belief(maps::Cell cell, const Floor& floor) const;
  /// The strength of its ground: prior of the class and evidence together; nothing where the cell has no
  /// class.
  std::optional<GroundBelief> ground(maps::Cell cell) const;

  /// Takes an observation in; planners see it after publish(). Ground whose class is known learns before its height is
  /// seen: patched in later it is what a map that began with it believes. What points to danger where the map has no
  /// class, or beyond its edge by less than the error of the pose, refuses that place as refuse() does, whatever is
  /// patched in later: a block and two standard deviations of the pose around. False when the place has no
  /// ground to learn about.
  bool learn(const WheelObservation& observation);
  /// Takes the pulls and sinkages of what was learned off again, as evidence().heardOf() gave them then, where something else
  /// is to count in their place; bounds of the place stay. Planners see it after publish().
  void forget(const SavedBlock& heard);
  /// Puts saved evidence of a block back, as read from a file; planners see it after publish(). False when the map has
  /// no such block or class.
  bool restore(const SavedBlock& saved);

  /// Ids of the drives that were put into it (driveId()), sorted.
  const std::set<std::string>& drives() const noexcept { return drives_; }
  /// Notes that a drive is in; `continued` is the id that it had when it was shorter, if any.
  void noteDrive(const std::string& id, const std::string& continued = {}) {
    drives_.erase(continued);
    drives_.insert(id);
  }

  /// Declares the ground around a place impassable, as a driver does who got stuck there: Hazard::Obstacle on
  /// every cell whose centre lies within the radius, > 0. Planners see it after publish(); a map file keeps it.
  /// Throws std::invalid_argument for a place or radius that is no finite number.
  void refuse(const maps::Point& place, double radius_m);

  /// Takes a window of ground in and publishes it, with all that was learned before, as one new version: heights,
  /// rocks, classes and keep-out count from then on as if the map had been built with them. Measures only the cells
  /// that a footprint, a clearance or the wheels' swath carries the change to; evidence stays where it is, with the
  /// class that it was learned of. Throws std::invalid_argument, in one line with place and remedy, for a patch of
  /// another resolution, off the map, without an observation or with an impossible value; the map stays as it was.
  void patch(const SurfacePatch& patch);

  /// The map of the window that lies so many whole tiles of 64 cells further east (columns) and north (rows): what
  /// lies in both keeps all that is known and believed of it, refused places included; tiles that come in are unseen; what
  /// falls off is forgotten. Equal to a map built at once from what is left. Its version follows on this one's. Throws
  /// std::invalid_argument where nothing of the map would be left.
  TraversabilityMap moved(maps::Cell tiles, const ProgressMonitor& watch = {}) const;

  /// Publishes what was learned since the last time as a new version: rewrites the cells whose ground changed,
  /// or that of a cell within reach of their wheels, and shares the tiles that hold none. Readers never wait; a
  /// planner that runs keeps its version. Where the numbers of cost curves run out all cells are given theirs
  /// anew, in steps as coarse as it takes (GroundKind).
  ///
  /// The costs are those of publishAll() to the bit, whatever was learned, patched, refused and published before: a cell
  /// depends on its shape, the classes in steps (ClassLessons::stateInSteps()) and the evidence that can reach its patch of
  /// blocks, and is looked at again whenever one of these changed. Where curves ran out steps may be up to 8 times as
  /// coarse as publishAll() would have them; then no cost is lower.
  void publish();
  /// The same over all cells.
  void publishAll();

 private:
  bool refuseUnobserved(const WheelObservation& observation);

  std::shared_ptr<MapSurface> surface_;
  EvidenceField field_;
  std::unique_ptr<MapCosts> costs_;
  std::set<std::string> drives_;
  std::unique_ptr<std::atomic_flag> changing_;  // cannot move
};

}  // namespace talus::costmap
