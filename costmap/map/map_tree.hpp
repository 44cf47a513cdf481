#pragma once

#include <iosfwd>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// Returns an OctoMap octree with the estimate of each cell of the map, at the cell's elevation.
TraversabilityTree treeOf(const TraversabilityMap& map);

/// Writes the octree of treeOf() without storing it in memory. The stream must be seekable.
void writeTree(const TraversabilityMap& map, std::ostream& stream);

}  // namespace talus::costmap
