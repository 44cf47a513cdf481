#pragma once

#include <optional>

#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/costmap/surface/floors.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

class TraversabilityMap;

/// Estimates of cells from surface, evidence and published category. Caches data common to adjacent cells.
/// Valid until the map changes. Not thread-safe.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const TraversabilityMap& map);

  /// Estimate of a cell inside the map.
  CellBelief at(maps::Cell cell);
  /// Returns the estimate of a floor of a cell: soil strength only, with unknown shape (Hazard::Unknown).
  CellBelief at(maps::Cell cell, const Floor& floor) const;
  /// Strength of a cell's ground from the prior of the class and the evidence; nullopt for a cell without a
  /// class.
  std::optional<GroundBelief> ground(maps::Cell cell);

 private:
  const TraversabilityMap& map_;
  EvidenceBeliefs beliefs_;
};

}  // namespace talus::costmap
