#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

class OGRGeometry;

namespace talus::maps {

/// Callback with the name of a feature and its geometry in map metres, two-dimensional and without curves;
/// null for no geometry.
using FeatureVisitor = std::function<void(const std::string& name, const OGRGeometry* drawn)>;

/// Visits a vector file. Returns the document of a GeoJSON file in longitude and latitude, or of a map
/// without a CRS. For any other file, calls `visit` for each feature, with one feature in memory at a time,
/// and returns nullopt. @throws InputError as readVector()
std::optional<nlohmann::json> visitVector(const std::string& path, const ElevationMap& map,
                                          const FeatureVisitor& visit);

/// Refuses more than a million positions of places or of a path. @throws InputError
void requireFewPositions(std::size_t positions, const std::string& path);

/// Reads a vector file as GeoJSON. A GeoJSON document in longitude and latitude is returned unchanged.
/// Features of other formats, and of GeoJSON in a projected CRS, are converted to map metres ("crs":
/// "local"), each with its name. @throws InputError: missing or damaged file, no feature, no CRS although the
/// map has a CRS, another body, or beyond the memory budget or a million positions
nlohmann::json readVector(const std::string& path, const ElevationMap& map);

/// Returns true if the name has the ending of a vector file (.geojson, .gpkg, .kml ...).
bool isNamedAsVector(const std::string& path);

}  // namespace talus::maps
