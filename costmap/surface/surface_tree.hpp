#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

#include <octomap/ColorOcTree.h>

#include <talus/costmap/surface/surface_cells.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// A voxel of ground beneath the surface.
struct FloorLeaf {
  octomap::OcTreeKey key;
  CellBelief belief;
};

/// A surface of cells to be turned into an octree.
struct Surface {
  const maps::Raster<float>& elevation_m;  ///< NaN: no cell there
  const SurfaceKeys& keys;
  std::vector<FloorLeaf> floors{};  ///< none in a voxel of the surface
};

/// The tree of a surface: one leaf a cell at its elevation and one a floor, equal neighbours pruned as the
/// tree is built, so that memory follows what is different rather than how many cells there are.
TraversabilityTree surfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief);

/// Writes that tree without holding it: the bytes of writeTree(surfaceTree(...)), in next to no memory. The
/// stream must be able to seek.
void writeSurfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief,
                      std::ostream& stream);

/// The surface, without floors, as a tree that stock octovis opens: green safe, amber marginal, red dangerous
/// or refused, grey unknown.
std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief);

}  // namespace talus::costmap
