#pragma once

#include <istream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/surface/floors.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// Returns the tree type of an OctoMap file ("OcTree", "ColorOcTree", "TraversabilityTree", ...); nullopt if
/// the file cannot be opened or is not an OctoMap.
std::optional<std::string> octomapType(const std::string& path);

/// Ground found in an OctoMap of occupied and free voxels: one surface, and further floors in its columns of
/// voxels.
struct OctomapGround {
  maps::ElevationMap surface;  ///< elevation map in local metres
  /// Ground beneath the surface and, if a ceiling was given, also above the surface.
  std::vector<Floor> floors;
};

/// Returns the ground of a .bt or .ot file of type OcTree or ColorOcTree. Ground voxels are occupied voxels
/// with free or unknown space of at least Floors::kHeadroom_m and two voxels above. In each column of voxels,
/// the elevation of the surface is the centre of the highest ground voxel at or below the height `ceiling_m`
/// [m]; NaN if there is no such voxel. The error of a flat surface is at most half a voxel. All other ground
/// voxels are floors. Throws InputError for a file that is truncated, of another type, empty (or empty below
/// the ceiling), or larger than 4e8 columns.
OctomapGround octomapGround(const std::string& path,
                            double ceiling_m = std::numeric_limits<double>::infinity());

/// Returns the ground of an octree in a stream instead of a file; `name` names the stream in error messages.
OctomapGround octomapGround(std::istream& stream, const std::string& name,
                            double ceiling_m = std::numeric_limits<double>::infinity());

}  // namespace talus::costmap
