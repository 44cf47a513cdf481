#pragma once

#include <functional>
#include <memory>

#include <octomap/ColorOcTree.h>

#include <costmap/surface_cells.hpp>
#include <costmap/traversability_tree.hpp>

namespace talus::costmap {

/// A surface of cells to be turned into an octree.
struct Surface {
  const maps::Raster<float>& elevation_m;  ///< NaN: no cell there
  const SurfaceKeys& keys;
};

/// The tree of a surface: one leaf a cell at its elevation, equal neighbours pruned as the tree is built, so
/// that memory follows what is different rather than how many cells there are.
TraversabilityTree surfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief);

/// The same surface as a tree that stock octovis opens: green safe, amber marginal, red dangerous or refused,
/// grey unknown.
std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief);

}  // namespace talus::costmap
