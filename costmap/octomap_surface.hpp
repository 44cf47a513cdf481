#pragma once

#include <istream>
#include <optional>
#include <string>

#include <maps/elevation_map.hpp>

namespace talus::costmap {

/// The tree type of an OctoMap file ("OcTree", "ColorOcTree", "TraversabilityTree", ...); nothing when the
/// file cannot be opened or is no OctoMap.
std::optional<std::string> octomapType(const std::string& path);

/// The top surface of a point-cloud OctoMap, .bt or .ot of type OcTree or ColorOcTree: in each column of
/// voxels the middle of the highest occupied one, NaN where there is none. Half a voxel is the most a flat
/// surface is off. Local metres. Throws InputError for a file that is truncated, of another type, empty, or
/// larger than 4e8 columns.
maps::ElevationMap octomapSurface(const std::string& path);

/// The same from a stream; `name` for messages.
maps::ElevationMap octomapSurface(std::istream& stream, const std::string& name);

}  // namespace talus::costmap
