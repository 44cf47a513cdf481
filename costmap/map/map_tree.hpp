#pragma once

#include <iosfwd>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// The map as an octree of estimates: all cells at their elevation, and the floors with evidence.
TraversabilityTree treeOf(const TraversabilityMap& map);

/// Writes the octree of treeOf() without storing the tree in memory; the stream must be seekable.
void writeTree(const TraversabilityMap& map, std::ostream& stream);

}  // namespace talus::costmap
