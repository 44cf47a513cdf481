#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::cli {

struct Context;

/// File names accepted by writeRoute(), as an option's type name.
inline constexpr const char* kRouteFiles = "ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|ROUTE.csv";

/// Refuses a file format that cannot store routes of the map, before planning. @throws InputError
void requireRouteFormat(const std::string& path, const maps::ElevationMap& map);

/// Writes a route of routeGeoJson() in the format given by the ending of the name: GeoPackage (CRS of the
/// map; layers route, vertices and segments), GPX and KML (Earth only), CSV of the vertices, otherwise
/// GeoJSON. Warns if GeoJSON cannot state the body of the map. @throws InputError
void writeRoute(const std::string& path, const nlohmann::ordered_json& route, const maps::ElevationMap& map,
                const Context& context);

}  // namespace talus::cli
