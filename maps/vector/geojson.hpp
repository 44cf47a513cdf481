#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Reads a GeoJSON file. @throws InputError: missing, unreadable, not JSON, not GeoJSON, or beyond the memory
/// budget (32 bytes per byte of the file)
nlohmann::json readGeoJson(const std::string& path);

/// Returns true if the document's "crs", in the form before RFC 7946, is a system in metres.
bool namesProjectedCrs(const nlohmann::json& document);

/// Geometries of a FeatureCollection, Feature, GeometryCollection or geometry, in order, as references into
/// the document.
std::vector<std::reference_wrapper<const nlohmann::json>> geometries(const nlohmann::json& document);

/// Converts positions of a GeoJSON document to map coordinates. Longitude and latitude [deg] are projected
/// with the map's georeference. Positions are already in map metres if the map has no georeference or the
/// document has "crs": "local".
class PositionReader {
 public:
  PositionReader(const nlohmann::json& document, const ElevationMap& map, std::string path);

  /// Converts a position. @throws InputError unless the position has two or three numbers in range
  Point operator()(const nlohmann::json& position) const;

 private:
  const Georeference* georeference_;  // of the map; null: positions in map metres
  std::string path_;
};

}  // namespace talus::maps
