#pragma once

#include <functional>
#include <iosfwd>
#include <istream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <octomap/ColorOcTree.h>

#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// Constants of OctoMap's keys, i.e. of the integer positions of voxels along one axis.

inline constexpr unsigned kOctreeDepth = 16;  ///< number of levels below the root
inline constexpr int kCentreKey = 32768;      ///< key of the voxel whose lower corner is at the coordinate 0

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

/// Returns the tree type of an OctoMap file ("OcTree", "ColorOcTree", "TraversabilityTree", ...); nullopt if
/// the file cannot be opened or is not an OctoMap.
std::optional<std::string> octomapType(const std::string& path);

/// Free height [m] that ground needs above it (ours); a lower gap is treated as a hole in the scan.
inline constexpr double kHeadroom_m = 0.5;

/// Returns the ground of a .bt or .ot file of type OcTree or ColorOcTree, in local metres. Ground voxels are
/// occupied voxels with free or unknown space of at least kHeadroom_m and two voxels above. In each column of
/// voxels, the elevation is the centre of the highest ground voxel at or below the height `ceiling_m` [m];
/// NaN if there is no such voxel. The error of a flat surface is at most half a voxel. Throws InputError for a
/// file that is truncated, of another type, empty (or empty below the ceiling), or larger than 4e8 columns.
maps::ElevationMap octomapGround(const std::string& path,
                                 double ceiling_m = std::numeric_limits<double>::infinity());

/// Returns the ground of an octree in a stream instead of a file; `name` names the stream in error messages.
maps::ElevationMap octomapGround(std::istream& stream, const std::string& name,
                                 double ceiling_m = std::numeric_limits<double>::infinity());

}  // namespace talus::costmap
