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

/// Number of cells of each category. Refused cells with a hazard are dangerous, unseen cells are unknown.
struct CategoryCounts {
  std::size_t safe = 0, marginal = 0, dangerous = 0, unknown = 0;
};

/// Category of a cell and its probability.
struct CellCategory {
  std::uint8_t category = 0;    ///< terramech::Category as a number
  std::uint8_t confidence = 0;  ///< probability in steps of 1/16; dangerous: rounded to nearest, else down
};

/// The published cost grid and the changes since its newest version. published() may be called from any
/// thread at any time, other const members while no thread changes the map. Only the map calls non-const
/// members.
class MapCosts {
 public:
  /// Measures the surface and publishes version 1, without evidence from wheels.
  MapCosts(std::shared_ptr<MapSurface> surface, const ProgressMonitor& watch);
  ~MapCosts();

  /// The newest version.
  std::shared_ptr<const CostGrid> published() const noexcept;

  /// Ground estimate from which the published cost of a cell follows, after WheelSwath and the quantisation
  /// of the cost curves; nullopt for blocked and unknown cells.
  std::optional<GroundBelief> ground(maps::Cell cell) const;
  /// Published category of a cell; nullopt for blocked and unknown cells.
  std::optional<CellCategory> ranked(maps::Cell cell) const;
  /// Published category as a number (terramech::Category); blocked cells are dangerous.
  std::uint8_t category(maps::Cell cell) const noexcept { return categoryOf(*published(), cell); }
  CategoryCounts countCategories() const;

  /// Marks cells whose estimate (learned) or whose hazards or class (changed) may differ from the last
  /// version.
  void noteLearned(const maps::CellBox& box);
  void noteChanged(const maps::CellBox& box) { changed_.push_back(box); }
  /// Marks the changes of a patch; `classes`: true if the patch has terrain classes.
  void notePatched(MapSurface::PatchEffect effect, bool classes);

  /// Publishes the marked changes as a new version; see TraversabilityMap::publish().
  void publish(const EvidenceField& field);
  /// Recomputes and publishes all cells.
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
  std::shared_ptr<const CostGrid> renumbered();

  std::shared_ptr<MapSurface> surface_;
  std::unique_ptr<GroundCurves> curves_;
  std::unique_ptr<PublishedGrid> published_;
  std::vector<maps::CellBox> learned_, changed_;    // since the last version
  std::optional<MapSurface::Gradients> gradients_;  // gradients of the next version
  std::optional<HeightTable> heights_m_;            // heights of the next version, whole map
};

}  // namespace talus::costmap
