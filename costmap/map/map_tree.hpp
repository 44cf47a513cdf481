#pragma once

#include <iosfwd>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// The whole map as an octree of estimates: every cell at its elevation, and the floors beneath it that have evidence.
TraversabilityTree treeOf(const TraversabilityMap& map);

/// Writes that tree without holding it in memory; the stream must be able to seek.
void writeTree(const TraversabilityMap& map, std::ostream& stream);

}  // namespace talus::costmap
