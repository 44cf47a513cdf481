#pragma once

#include <istream>
#include <limits>
#include <optional>
#include <string>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

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
