#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

class OGRGeometry;

namespace talus::maps {

/// Callback with the name of a feature and its geometry in map coordinates [m]. The geometry is
/// two-dimensional and has no curves; null for a feature without a geometry.
using FeatureVisitor = std::function<void(const std::string& name, const OGRGeometry* drawn)>;

/// Reads a vector file feature by feature. For a GeoJSON file that is in longitude and latitude, or that is
/// read for a map without a CRS, returns the document. For any other file, calls `visit` for each feature,
/// with one feature in memory at a time, and returns nullopt. @throws InputError in the cases of readVector()
std::optional<nlohmann::json> visitVector(const std::string& path, const ElevationMap& map,
                                          const FeatureVisitor& visit);

/// Checks that a file has at most a million positions of points or of a line. @throws InputError for more
/// positions
void requireFewPositions(std::size_t positions, const std::string& path);

/// Returns a vector file as GeoJSON. A GeoJSON document in longitude and latitude is returned unchanged.
/// Features of other formats, and of GeoJSON in a projected CRS, are converted to map coordinates ("crs":
/// "local"), each with its name. @throws InputError if the file is missing or damaged, has no feature, has no
/// CRS although the map has a CRS, belongs to another body, or exceeds the memory budget or a million
/// positions
nlohmann::json readVector(const std::string& path, const ElevationMap& map);

/// Returns true if the file name has the ending of a vector format (.geojson, .gpkg, .kml ...).
bool isNamedAsVector(const std::string& path);

}  // namespace talus::maps
