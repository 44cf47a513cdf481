#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {

/// MAP.ot: an OctoMap file of type TraversabilityTree (stock readers stop behind its nodes), then a trailer
/// with all that planning needs besides: grid, coordinate system, rover, soils, policy, elevation, classes,
/// declared hazards, evidence, the drives that it came from, and a checksum over all of it. The layout stands in
/// docs/map_file.md. Little-endian; same map, same bytes. The stream is empty and can be read, too.
void writeMap(const TraversabilityMap& map, std::iostream& stream);

/// Writes through OutputFile, so that a reader sees the whole file or none. Throws InputError when it cannot.
void writeMap(const TraversabilityMap& map, const std::string& path);

/// How a map is read back.
struct MapReading {
  std::string name;  ///< of the file, for messages
  int threads = 1;   ///< >= 1
  /// Of a coordinate system that the file names, on its grid; without one GeographicLib's, which reaches no latitude
  /// and longitude where PROJ is needed (maps::ElevationMap::places). talus::maps_io has one that uses PROJ.
  std::function<maps::Georeference(const maps::CoordinateSystem&, const maps::Grid&)> georeference{};
};

/// Reads a map from a stream that can seek and builds its cost grid. Throws InputError for a file that is truncated,
/// damaged in any bit, or no such map.
TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const ProgressMonitor& watch = {});

/// Opens the file of that name and reads. Throws InputError also when it cannot be opened.
TraversabilityMap readMap(const MapReading& reading, const ProgressMonitor& watch = {});
TraversabilityMap readMap(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});

}  // namespace talus::costmap
