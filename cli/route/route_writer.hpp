#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::cli {

struct Context;

/// File names that writeRoute() accepts, as the type name of an option.
inline constexpr const char* kRouteFiles = "ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|ROUTE.csv";

/// Checks, before planning, that the file format of `path` can store routes of the map. @throws InputError
/// otherwise
void requireRouteFormat(const std::string& path, const maps::ElevationMap& map);

/// Writes a route of routeGeoJson() in the format that the ending of the file name selects: GeoPackage (in
/// the CRS of the map, with the layers route, vertices and segments), GPX and KML (Earth only), CSV of the
/// vertices, and GeoJSON for all other endings. Warns if GeoJSON cannot state the frame of the map. The GeoPackage contains styles for QGIS. @throws
/// InputError
void writeRoute(const std::string& path, const nlohmann::ordered_json& route, const maps::ElevationMap& map,
                const Context& context);

}  // namespace talus::cli
