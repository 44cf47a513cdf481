#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

class OGRGeometry;

namespace talus::maps {

/// Called with a feature's name and its geometry in map metres, in two dimensions and without curves; null where it has none.
using FeatureVisitor = std::function<void(const std::string& name, const OGRGeometry* drawn)>;

/// The document of a GeoJSON file in longitude and latitude, or of a map without a CRS. Of any other file, nothing after a
/// call for each of its features, one in memory at a time. @throws InputError as readVector()
std::optional<nlohmann::json> visitVector(const std::string& path, const ElevationMap& map,
                                          const FeatureVisitor& visit);

/// Refuses more than a million positions of places or of a path. @throws InputError
void requireFewPositions(std::size_t positions, const std::string& path);

/// A vector file as GeoJSON: a GeoJSON document in longitude and latitude as it stands; the features of any other file that
/// openVector() takes, and of GeoJSON in a projected CRS, in map metres ("crs": "local"), each with its name.
/// @throws InputError: no such file, damaged, no feature, without a CRS although the map has one, of another body, beyond
/// the memory budget or a million positions
nlohmann::json readVector(const std::string& path, const ElevationMap& map);

/// Whether a name ends as those of vector files do (.geojson, .gpkg, .kml ...).
bool isNamedAsVector(const std::string& path);

}  // namespace talus::maps
