#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::cli {

struct Context;

/// Names of files that writeRoute() writes, as an option's type name.
inline constexpr const char* kRouteFiles = "ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|ROUTE.csv";

/// Refuses a name whose format cannot have a route of that map, before it is planned. @throws InputError
void requireRouteFormat(const std::string& path, const maps::ElevationMap& map);

/// Writes a route, as routeGeoJson() makes it, in the format that the name ends in: GeoPackage (in the CRS of the map, layers
/// route, vertices and segments), GPX and KML (of Earth alone), CSV of its vertices, else GeoJSON. Warns where GeoJSON does
/// not say the body. @throws InputError
void writeRoute(const std::string& path, const nlohmann::ordered_json& route, const maps::ElevationMap& map,
                const Context& context);

}  // namespace talus::cli
