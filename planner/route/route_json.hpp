#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// A file that a route was made from.
struct RouteInput {
  std::string file;  ///< its name without the folder
  std::string
      path{};  ///< as it was given to the planner, relative to its folder; empty where the route has none
  std::string sha256{};  ///< of its content, hexadecimal
};

/// What it takes to make a route again.
struct RouteOrigin {
  std::vector<RouteInput> files;  ///< that were read
  std::uint64_t seed = 1;
  std::string rover{};               ///< its name
  std::vector<std::string> soils{};  ///< names of those that the map's classes stand for
  std::string command{};  ///< the call that makes the route, for a shell; empty where there is none
};

/// The origin as the "inputs" of a route's file.
nlohmann::ordered_json originJson(const RouteOrigin& origin);

/// The summary fields of a route, with its status; null where there is no route, with why ("obstruction") where that is
/// known.
nlohmann::ordered_json summaryJson(const Route& route);

/// The route as a GeoJSON FeatureCollection: longitude, latitude and elevation where the map has a CRS, else
/// map metres and "crs": "local"; a LineString needs two positions, so a standstill is repeated. Layout: docs
/// of `talus plan`.
nlohmann::ordered_json routeGeoJson(const Route& route, const maps::ElevationMap& map,
                                    const RouteOrigin& origin);

}  // namespace talus::planner
