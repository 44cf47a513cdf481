#pragma once

#include <optional>

#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/costmap/surface/floors.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

class TraversabilityMap;

/// Questions about places of a map: the estimate of a cell from its surface, its evidence and its published category. Keeps
/// what neighbouring cells share, for many questions in a row. Valid until the map changes. Not thread-safe.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const TraversabilityMap& map);

  /// The estimate of a cell inside the map.
  CellBelief at(maps::Cell cell);
  /// The estimate of a cell's floor: the strength of its ground. Its shape is not judged: Hazard::Unknown.
  CellBelief at(maps::Cell cell, const Floor& floor) const;
  /// The strength of a cell's ground: prior of the class and evidence together; nothing where the cell has no class.
  std::optional<GroundBelief> ground(maps::Cell cell);

 private:
  const TraversabilityMap& map_;
  EvidenceBeliefs beliefs_;
};

}  // namespace talus::costmap
