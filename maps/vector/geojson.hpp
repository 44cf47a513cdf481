#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Reads a GeoJSON file. @throws InputError: missing, unreadable, no JSON, not GeoJSON, beyond the memory budget (32
/// bytes for each of the file)
nlohmann::json readGeoJson(const std::string& path);

/// Whether its "crs", as GeoJSON had it before RFC 7946, is one in metres.
bool namesProjectedCrs(const nlohmann::json& document);

/// The geometries of a FeatureCollection, Feature, GeometryCollection or geometry, in order; they refer to the
/// document.
std::vector<std::reference_wrapper<const nlohmann::json>> geometries(const nlohmann::json& document);

/// How positions of a GeoJSON document become map metres: longitude and latitude in degrees through the map's
/// georeference, or map metres as they stand when the map has none or the document says "crs": "local".
class PositionReader {
 public:
  PositionReader(const nlohmann::json& document, const ElevationMap& map, std::string path);

  /// @throws InputError on anything but two or three numbers in range
  Point operator()(const nlohmann::json& position) const;

 private:
  const Georeference* georeference_;  // of the map; null: local metres
  std::string path_;
};

}  // namespace talus::maps
