#pragma once

#include <functional>
#include <iosfwd>
#include <memory>

#include <octomap/ColorOcTree.h>

#include <talus/costmap/surface/surface_cells.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// Input of an octree.
struct Surface {
  const maps::Raster<float>& elevation_m;  ///< elevation of the surface; a NaN cell has no leaf
  const SurfaceKeys& keys;
};

/// Returns the octree of a surface: one leaf per cell at its elevation. The function `belief` returns the
/// estimate of a cell. Equal neighbours are pruned (merged) during construction, so that memory depends on
/// the number of different leaves.
TraversabilityTree surfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief);

/// Writes the bytes of writeTree(surfaceTree(...)) without storing the tree in memory. The stream must be
/// seekable.
void writeSurfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief,
                      std::ostream& stream);

/// Returns the surface as an octree for the viewer octovis: green for safe, amber for
/// marginal, red for dangerous or refused, and grey for unknown cells.
std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief);

}  // namespace talus::costmap
