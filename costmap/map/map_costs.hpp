#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/map/map_surface.hpp>

namespace talus::costmap {

class EvidenceField;
class GroundCurves;
class PublishedGrid;

/// Number of cells of each category. Refused cells with a hazard count as dangerous, unobserved cells as
/// unknown.
struct CategoryCounts {
  std::size_t safe = 0, marginal = 0, dangerous = 0, unknown = 0;
};

/// Category of a cell and the probability of the category.
struct CellCategory {
  std::uint8_t category = 0;  ///< terramech::Category as a number
  /// Probability in steps of 1/16, rounded to nearest if dangerous and down otherwise.
  std::uint8_t confidence = 0;
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
  /// WheelSwath combined the ground under all wheels and after quantisation (GroundKind); nullopt for blocked
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

}  // namespace talus::costmap
