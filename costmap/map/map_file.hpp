#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/traversability_tree.hpp>

namespace talus::costmap {

/// Returns an OctoMap octree with the estimate of each cell of the map, at the cell's elevation.
TraversabilityTree treeOf(const TraversabilityMap& map);

/// Writes the octree of treeOf() without storing it in memory. The stream must be seekable.
void writeTree(const TraversabilityMap& map, std::ostream& stream);

/// Writes a map in the format MAP.ot: an OctoMap file of type TraversabilityTree, followed by a trailer.
/// Other programs stop reading after the tree nodes. The trailer contains the grid, coordinate system, rover,
/// soils, policy, elevation, terrain classes, declared hazards, evidence, drives, cost layers and a checksum
/// of the whole file. docs/map_file.md specifies the layout. Numbers are little-endian; equal maps give equal
/// bytes. The stream must be empty and readable.
void writeMap(const TraversabilityMap& map, std::iostream& stream);

/// Writes the map to the file `path`. The file is replaced atomically (OutputFile). Throws InputError if the
/// file cannot be written.
void writeMap(const TraversabilityMap& map, const std::string& path);

/// Options for reading a map.
struct MapReading {
  std::string name;  ///< path of the file; names the file or stream in error messages
  int threads = 1;   ///< number of threads, >= 1
  /// Makes the georeference (conversion to latitude and longitude) from a coordinate system and a grid. The
  /// default uses GeographicLib and provides no latitude and longitude for coordinate systems that need PROJ
  /// (maps::ElevationMap::places). talus::maps_io provides a function that uses PROJ.
  std::function<maps::Georeference(const maps::CoordinateSystem&, const maps::Grid&)> georeference{};
};

/// Returns the map that a seekable stream contains, with its cost grid. `watch` receives the progress. Throws
/// InputError if the stream is truncated, damaged, or not a map.
TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const ProgressMonitor& watch = {});

/// Returns the map that the file `reading.name` or `path` contains. Throws InputError also if the file cannot
/// be opened.
TraversabilityMap readMap(const MapReading& reading, const ProgressMonitor& watch = {});
TraversabilityMap readMap(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});

}  // namespace talus::costmap
