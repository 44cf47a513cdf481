#pragma once

#include <istream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/surface/floors.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// The tree type of an OctoMap file ("OcTree", "ColorOcTree", "TraversabilityTree", ...); nothing when the
/// file cannot be opened or is no OctoMap.
std::optional<std::string> octomapType(const std::string& path);

/// The ground of a point-cloud OctoMap: one surface, and what other floors its columns have.
struct OctomapGround {
  maps::ElevationMap surface;  ///< local metres
  std::vector<Floor> floors;   ///< beneath the surface and, with a ceiling, above it
};

/// Reads a .bt or .ot of type OcTree or ColorOcTree. Its surface is, in each column of voxels, the middle of
/// the highest occupied one whose middle is not above `ceiling_m`, NaN where there is none; half a voxel is
/// the most a flat surface is off. A floor is any other occupied voxel with Floors::kHeadroom_m (and two
/// voxels) of free or unknown space above. Throws InputError for a file that is truncated, of another type,
/// empty (or empty below the ceiling), or larger than 4e8 columns.
OctomapGround octomapGround(const std::string& path,
                            double ceiling_m = std::numeric_limits<double>::infinity());

/// The same from a stream; `name` for messages.
OctomapGround octomapGround(std::istream& stream, const std::string& name,
                            double ceiling_m = std::numeric_limits<double>::infinity());

}  // namespace talus::costmap
