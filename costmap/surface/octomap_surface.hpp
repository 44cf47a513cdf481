#pragma once

#include <istream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/surface/floors.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// Tree type of an OctoMap file ("OcTree", "ColorOcTree", "TraversabilityTree", ...); nullopt if the file
/// cannot be opened or is not an OctoMap.
std::optional<std::string> octomapType(const std::string& path);

/// Ground of a point-cloud OctoMap: the surface and the other floors of its columns.
struct OctomapGround {
  maps::ElevationMap surface;  ///< local metres
  std::vector<Floor> floors;   ///< floors beneath the surface and, with a ceiling, above the surface
};

/// Reads a .bt or .ot file of type OcTree or ColorOcTree. Ground voxels are occupied voxels with free or
/// unknown space of at least Floors::kHeadroom_m and two voxels above. The surface is, in each column, the
/// centre of the highest ground voxel at or below `ceiling_m`; NaN without such a voxel. The error of a flat
/// surface is at most half a voxel. All other ground voxels are floors. Throws InputError for a file that is
/// truncated, of another type, empty (or empty below the ceiling), or larger than 4e8 columns.
OctomapGround octomapGround(const std::string& path,
                            double ceiling_m = std::numeric_limits<double>::infinity());

/// Reads the octree from a stream instead of a file; `name` identifies the stream in messages.
OctomapGround octomapGround(std::istream& stream, const std::string& name,
                            double ceiling_m = std::numeric_limits<double>::infinity());

}  // namespace talus::costmap
