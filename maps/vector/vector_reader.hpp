#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A vector file as GeoJSON: a GeoJSON document in longitude and latitude as it stands; the features of any other file that
/// openVector() takes, and of GeoJSON in a projected CRS, in map metres ("crs": "local"), each with its name.
/// @throws InputError: no such file, damaged, no feature, without a CRS although the map has one, of another body, beyond
/// the memory budget
nlohmann::json readVector(const std::string& path, const ElevationMap& map);

/// Whether a name ends as those of vector files do (.geojson, .gpkg, .kml ...).
bool isNamedAsVector(const std::string& path);

}  // namespace talus::maps
