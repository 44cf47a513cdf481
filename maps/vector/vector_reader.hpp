#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/maps.hpp>

class OGRGeometry;

namespace talus::maps {

/// Callback with the name of a feature and its geometry in map coordinates [m]. The geometry is
/// two-dimensional and has no curves; null for a feature without a geometry.
using FeatureVisitor = std::function<void(const std::string& name, const OGRGeometry* drawn)>;

/// Calls `visit` for each feature of a vector file, with one feature in memory at a time (of GeoJSON in longitude and
/// latitude or map metres: the document). @throws InputError if the file is missing or damaged, has no feature, has no
/// CRS although the map has a CRS, or belongs to another body
void visitVector(const std::string& path, const ElevationMap& map, const FeatureVisitor& visit);

/// Returns the first point of a vector file in map coordinates [m]. @throws InputError if there is none, or in the
/// cases of visitVector()
Point readPoint(const std::string& path, const ElevationMap& map);

/// Returns the first line of a vector file in map coordinates [m]. @throws InputError if there is none, if it has
/// several parts or more than a million positions, or in the cases of visitVector()
std::vector<Point> readLine(const std::string& path, const ElevationMap& map);

/// Checks that a file has at most a million positions of points or of a line. @throws InputError for more
/// positions
void requireFewPositions(std::size_t positions, const std::string& path);

/// Returns true if the file name has the ending of a vector format (.geojson, .gpkg, .kml ...).
bool isNamedAsVector(const std::string& path);

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
