#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/costmap/surface/surface_cells.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>
#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

class GroundCurves;
struct PublishedMap;

/// How many cells fall in each category, hazards counted as dangerous where they refuse the cell, unknown
/// where unseen.
struct CategoryCounts {
  std::size_t safe = 0, marginal = 0, dangerous = 0, unknown = 0;
};

/// Everything that is believed of a site: its surface, the prior of each cell's ground, the evidence that the
/// wheels brought, and the cost grid that planners read. Fifteen bytes a cell and some sixty a block that was driven.
///
/// One thread changes a map: a second that calls learn(), refuse(), patch() or publish() meanwhile gets a
/// std::logic_error. published() may be called from any thread at any time and never waits.
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

  const maps::Grid& grid() const noexcept { return site_->grid(); }
  const maps::ElevationMap& elevation() const noexcept { return site_->elevation; }
  const GroundModel& model() const noexcept { return *site_->model; }
  const HazardLimits& hazardLimits() const noexcept { return limits_; }
  double footprintRadius_m() const noexcept { return footprint_radius_m_; }
  /// How the shape of the ground is measured, on a number of threads >= 1.
  maps::FootprintOptions footprint(int threads) const noexcept {
    return {.radius_m = footprint_radius_m_, .step_span_m = limits_.wheel_diameter_m, .threads = threads};
  }

  /// The newest published version, for planners to pin.
  std::shared_ptr<const CostGrid> published() const noexcept;

  /// Gradient, curve number of a cell inside the map.
  CellCode code(maps::Cell cell) const noexcept { return published()->at(cell); }
  const maps::Raster<Hazard>& hazards() const noexcept { return hazards_; }
  const maps::Raster<std::uint8_t>& classes() const noexcept { return site_->classes; }
  const std::vector<CostLayer>& costLayers() const noexcept { return site_->costs; }
  Hazard hazards(maps::Cell cell) const noexcept { return hazards_[cell]; }
  /// Position of the cell's class in model().parts().classes, or -1.
  int classIndex(maps::Cell cell) const noexcept;
  /// The same of the ground at a height there, which is the first class beneath an overhang.
  int classIndex(maps::Cell cell, double z_m) const noexcept {
    return floorAt(cell, z_m) ? 0 : classIndex(cell);
  }
  /// Class number in the raster, 0 where there is no raster.
  int classNumber(maps::Cell cell) const noexcept;

  /// The ground that the published cost of a cell was made from: what its wheels' swath and the rounding of the
  /// cost curves make of ground(); nothing where no heading may enter or nobody has seen it.
  std::optional<GroundBelief> publishedGround(maps::Cell cell) const;

  /// All that is believed of a cell inside the map.
  CellBelief belief(maps::Cell cell) const;
  /// The strength of its ground: prior of the class and evidence together; nothing where the cell has no
  /// class.
  std::optional<GroundBelief> ground(maps::Cell cell) const;

  /// Ground beneath the top surface. It is no part of the cost grid: a planner drives on top.
  const Floors& floors() const noexcept { return site_->floors; }
  /// The floor that something at this height stands on; nothing where that is the top surface.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return site_->floorAt(cell, z_m);
  }
  /// All that is believed of a cell's floor: the strength of its ground. Its shape is not judged:
  /// Hazard::Unknown.
  CellBelief belief(maps::Cell cell, const Floor& floor) const;

  CategoryCounts countCategories() const;
  /// Category for people of a cell as published: terramech::Category as a number, hazards as dangerous.
  std::uint8_t category(maps::Cell cell) const noexcept { return categoryOf(*published(), cell); }

  /// What the wheels told so far.
  const EvidenceField& evidence() const noexcept { return field_; }

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
  /// All such places, in order.
  const std::vector<RefusedPlace>& refused() const noexcept { return refusals_; }

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

  /// The whole map as an octree of beliefs: every cell at its elevation, and the floors beneath it that
  /// wheels spoke for.
  TraversabilityTree tree() const;
  /// Writes that tree without holding it in memory; the stream must be able to seek.
  void writeTree(std::ostream& stream) const;
  const SurfaceKeys& keys() const noexcept { return site_->keys; }

 private:
  // New codes of the cells of a box, on a grid of its own, with their gradients alone; elevation of the whole map.
  struct Measured {
    maps::CellBox box;
    maps::Raster<CellCode> codes;
    HeightTable elevation_m;
  };

  TileTable measure(const MapLayers& layers, const ProgressMonitor& watch);
  maps::CellBox measureAgain(const maps::CellBox& window);
  void take(const SurfacePatch& patch, const maps::CellBox& window);
  void takeHazards(const SurfacePatch& patch, const maps::CellBox& window);
  Hazard layerHazards(maps::Cell cell) const;
  Hazard rocksOn(float abundance) const;
  Hazard spreading() const noexcept;
  maps::CellBox mark(const RefusedPlace& refusal, bool refused);
  /// Of danger where the map has no ground. False where it lies off the map.
  bool refuseUnobserved(const WheelObservation& observation);
  CellBelief belief(maps::Cell cell, EvidenceField::Beliefs& beliefs) const;
  std::uint8_t categoryOf(const CostGrid& grid, maps::Cell cell) const noexcept;
  CellCode coded(maps::Cell cell, CellCode code);
  void publish(std::vector<maps::CellBox> learned, bool whole = false);
  std::shared_ptr<const CostGrid> costed(const std::vector<maps::CellBox>& changed);
  std::shared_ptr<const CostGrid> rewritten(const std::vector<maps::CellBox>& ranges);
  std::shared_ptr<const CostGrid> renumbered();
  std::vector<FloorLeaf> floorLeaves() const;

  std::shared_ptr<GroundSite> site_;
  HazardLimits limits_;
  double footprint_radius_m_ = 0.0;
  int threads_ = 1;
  bool any_height_ = false;
  maps::Raster<Hazard> given_;  // by layers other than elevation and classes; empty: none
  maps::Raster<Hazard> hazards_;
  std::unique_ptr<GroundCurves> curves_;
  EvidenceField field_;
  std::vector<maps::CellBox> learned_;  // since the last version
  std::vector<maps::CellBox> changed_;  // otherwise, since the last version
  std::vector<RefusedPlace> refusals_;
  std::optional<Measured> measured_;  // not published yet
  std::set<std::string> drives_;
  std::unique_ptr<PublishedMap> published_;  // the lock in it cannot move
};

}  // namespace talus::costmap
