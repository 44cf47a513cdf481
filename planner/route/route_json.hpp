#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// An input file of a route.
struct RouteInput {
  std::string file;  ///< name without folder
  std::string
      path{};  ///< as given to the planner, relative to its working folder; empty if the route has none
  std::string sha256{};  ///< SHA-256 of the content, hexadecimal
};

/// Data needed to reproduce a route.
struct RouteOrigin {
  std::vector<RouteInput> files;  ///< files that were read
  std::uint64_t seed = 1;
  std::string rover{};               ///< name of the rover
  std::vector<std::string> soils{};  ///< names of the soils of the map's classes
  std::string command{};             ///< shell command that creates the route; empty if unknown
};

/// The origin as "inputs" of a route file.
nlohmann::ordered_json originJson(const RouteOrigin& origin);

/// Summary fields of a route with its status; null without a route, with the cause ("obstruction") if known.
nlohmann::ordered_json summaryJson(const Route& route);

/// The route as a GeoJSON FeatureCollection: longitude, latitude and elevation if the map has a CRS,
/// otherwise map coordinates [m] and "crs": "local". A LineString needs two positions; the position of a
/// single-vertex route is repeated. Layout: docs of `talus plan`.
nlohmann::ordered_json routeGeoJson(const Route& route, const maps::ElevationMap& map,
                                    const RouteOrigin& origin);

}  // namespace talus::planner
