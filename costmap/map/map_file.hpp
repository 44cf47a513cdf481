#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {

/// Writes MAP.ot: an OctoMap file of type TraversabilityTree (other programs stop reading after the nodes),
/// followed by a trailer. The trailer has the grid, coordinate system, rover, soils, policy, elevation,
/// classes, declared hazards, evidence, drives, cost layers and a checksum of the whole file.
/// docs/map_file.md specifies the layout. Little-endian; equal maps give equal bytes. The stream must be
/// empty and readable.
void writeMap(const TraversabilityMap& map, std::iostream& stream);

/// Writes the file atomically through OutputFile. Throws InputError on failure.
void writeMap(const TraversabilityMap& map, const std::string& path);

/// Options for reading a map.
struct MapReading {
  std::string name;  ///< file name for messages
  int threads = 1;   ///< >= 1
  /// Makes the georeference of a coordinate system and grid. The default uses GeographicLib, without latitude
  /// and longitude for coordinate systems that need PROJ (maps::ElevationMap::places); talus::maps_io
  /// provides a function with PROJ.
  std::function<maps::Georeference(const maps::CoordinateSystem&, const maps::Grid&)> georeference{};
};

/// Reads a map from a seekable stream and builds its cost grid. Throws InputError if the file is truncated,
/// damaged, or not a map.
TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const ProgressMonitor& watch = {});

/// Reads the map from the file reading.name. Throws InputError also if the file cannot be opened.
TraversabilityMap readMap(const MapReading& reading, const ProgressMonitor& watch = {});
TraversabilityMap readMap(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});

}  // namespace talus::costmap
