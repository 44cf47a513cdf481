#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// All content of a map file that is not a raster, written as CBOR (RFC 8949), which keeps the bits of numbers.
struct MapText {
  maps::Grid grid;
  std::optional<maps::CoordinateSystem> coordinate_system;
  std::string source;
  std::string reading{};           ///< ElevationMap::reading
  std::vector<InputFile> files{};  ///< ElevationMap::files
  double footprint_radius_m = 0.0;
  /// Rover, terrain classes and policy.
  GroundModel::Parts ground;
  std::vector<RefusedPlace> refused{};
  std::vector<SavedBlock> evidence{};
  std::map<std::string, TraversabilityMap::Drive> drives{};
};

/// Returns the content as bytes.
std::string written(const MapText& text);

/// Returns the content from these bytes. Throws InputError for bytes that are none, a missing part or a value of
/// another type; the error names the file `name`. A field that a part lacks has its default.
MapText parsed(const std::string& bytes, const std::string& name);

}  // namespace talus::costmap
