#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

#include <octomap/ColorOcTree.h>

#include <talus/costmap/surface/surface_cells.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// A floor voxel with its estimate.
struct FloorLeaf {
  octomap::OcTreeKey key;
  CellBelief belief;
};

/// Input of an octree: surface and floors.
struct Surface {
  const maps::Raster<float>& elevation_m;  ///< NaN: no cell
  const SurfaceKeys& keys;
  std::vector<FloorLeaf> floors{};  ///< floors outside the voxels of the surface
};

/// Octree of a surface: one leaf per cell at its elevation and one per floor. Equal neighbours are pruned
/// during construction, so that memory depends on the number of different leaves.
TraversabilityTree surfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief);

/// Writes the bytes of writeTree(surfaceTree(...)) without holding the tree in memory. The stream must be
/// seekable.
void writeSurfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief,
                      std::ostream& stream);

/// The surface, without floors, as a tree for octovis: green safe, amber marginal, red dangerous or refused,
/// grey unknown.
std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief);

}  // namespace talus::costmap
