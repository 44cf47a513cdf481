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

/// How many cells fall in each category, hazards counted as dangerous where they refuse the cell, unknown
/// where unseen.
struct CategoryCounts {
  std::size_t safe = 0, marginal = 0, dangerous = 0, unknown = 0;
};

/// A category and how certain it is.
struct CellCategory {
  std::uint8_t category = 0;    ///< terramech::Category as a number
  std::uint8_t confidence = 0;  ///< probability in steps of 1/16, rounded down unless it is of danger
};

/// The cost grid that planners read, version by version, and what changed since the newest one. published() may be called from
/// any thread at any time, other const members while no thread changes the map; only the map changes it.
class MapCosts {
 public:
  /// Measures the surface and publishes version 1, without any evidence.
  MapCosts(std::shared_ptr<MapSurface> surface, const ProgressMonitor& watch);
  ~MapCosts();

  /// The newest version, for planners to pin.
  std::shared_ptr<const CostGrid> published() const noexcept;

  /// The ground that the published cost of a cell was made from: what its wheels' swath and the rounding of the
  /// cost curves make of the estimate; nothing where no heading may enter or nobody has seen it.
  std::optional<GroundBelief> ground(maps::Cell cell) const;
  /// Category of a cell as published; nothing where no heading may enter it or it is unknown.
  std::optional<CellCategory> ranked(maps::Cell cell) const;
  /// The same for people, terramech::Category as a number: hazards as dangerous.
  std::uint8_t category(maps::Cell cell) const noexcept { return categoryOf(*published(), cell); }
  CategoryCounts countCategories() const;

  /// Notes cells whose estimate, or whose hazards or class, may have changed since the last version.
  void noteLearned(const maps::CellBox& box);
  void noteChanged(const maps::CellBox& box) { changed_.push_back(box); }
  /// Notes what a patch changed, classes among it or not.
  void notePatched(MapSurface::PatchEffect effect, bool classes);

  /// Publishes what was noted as a new version; see TraversabilityMap::publish().
  void publish(const EvidenceField& field);
  /// The same over all cells.
  void publishAll(const EvidenceField& field);
  /// Publishes the newest version again under another number.
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
  std::optional<MapSurface::Gradients> gradients_;  // not published yet, as the next
  std::optional<HeightTable> heights_m_;            // of the whole map
};

}  // namespace talus::costmap
