#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Returns the document of a GeoJSON file. @throws InputError if the file is missing, unreadable, not JSON,
/// not GeoJSON, or beyond the memory budget (32 bytes per byte of the file)
nlohmann::json readGeoJson(const std::string& path);

/// Returns true if the member "crs" of the document (GeoJSON before RFC 7946) names a system in metres.
bool namesProjectedCrs(const nlohmann::json& document);

/// Returns the geometries of a FeatureCollection, Feature, GeometryCollection or geometry, in order, as
/// references into the document.
std::vector<std::reference_wrapper<const nlohmann::json>> geometries(const nlohmann::json& document);

/// Converts positions of a GeoJSON document to map coordinates. Longitudes and latitudes [deg] are projected
/// with the georeference of the map. If the map has no georeference or the document has "crs": "local",
/// positions are map coordinates [m] already.
class PositionReader {
 public:
  PositionReader(const nlohmann::json& document, const ElevationMap& map, std::string path);

  /// Returns the map coordinates of a position. @throws InputError unless the position has two or three
  /// numbers in range
  Point operator()(const nlohmann::json& position) const;

 private:
  const Georeference* georeference_;  // georeference of the map; null: positions are map coordinates
  std::string path_;
};

}  // namespace talus::maps
