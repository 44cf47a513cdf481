#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {

/// Returns the document of a GeoJSON file. @throws InputError if the file is missing, unreadable, not JSON,
/// not GeoJSON, or beyond the memory budget (32 bytes per byte of the file)
nlohmann::json readGeoJson(const std::string& path);

/// Returns true if the member "crs" of the document (GeoJSON before RFC 7946) names a system in metres.
bool namesProjectedCrs(const nlohmann::json& document);

/// Calls `visit` for each feature of a document, or for its geometry. Longitudes and latitudes [deg] are projected
/// with the georeference of the map; if the map has none or the document states "crs": "local", positions are map
/// coordinates [m]. @throws InputError for a geometry that is none of RFC 7946, or a position that is not two or more
/// numbers in range
void visitGeoJson(const nlohmann::json& document, const ElevationMap& map, const std::string& path,
                  const FeatureVisitor& visit);

}  // namespace talus::maps
