#pragma once

#include <optional>

#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

class TraversabilityMap;

/// Computes the estimates of the cells of a map from its surface, evidence and published categories. Data
/// common to adjacent cells are cached. Valid until the map changes. Not thread-safe.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const TraversabilityMap& map);

  /// Returns the estimate of a cell inside the map.
  CellBelief at(maps::Cell cell);
  /// Returns the estimated strength of a cell's ground, from the prior of the terrain class and the evidence;
  /// nullopt for a cell without a class.
  std::optional<GroundBelief> ground(maps::Cell cell);

 private:
  const TraversabilityMap& map_;
  EvidenceBeliefs beliefs_;
};

}  // namespace talus::costmap
