#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Input file of a route.
struct RouteInput {
  std::string file;      ///< file name without folder
  std::string path{};    ///< path given to the planner, relative to its working folder; empty: unknown
  std::string sha256{};  ///< SHA-256 of the file content, hexadecimal
  std::string role{};    ///< what the file states: "elevation", "rover", "mission", ...; empty: unknown
};

/// Data with which a route can be computed again.
struct RouteOrigin {
  std::vector<RouteInput> files;     ///< files that the planner read
  std::uint64_t seed = 1;            ///< seed of the planner
  std::string rover{};               ///< name of the rover
  std::vector<std::string> soils{};  ///< names of the soils, one per terrain class of the map
  std::string command{};             ///< shell command that computes the route; empty if unknown
};

/// Returns the origin in the JSON form of "inputs" of a route file.
nlohmann::ordered_json originJson(const RouteOrigin& origin);

/// Returns the status and the summary of the route. If there is no route, the summary values are null, and
/// "obstruction" contains the cause if it is known.
nlohmann::ordered_json summaryJson(const Route& route);

/// Returns the route in the form of a GeoJSON FeatureCollection. Positions are longitude, latitude and
/// elevation if the map has a CRS, otherwise map coordinates [m] with "crs": "local". A LineString needs two
/// positions; therefore the position of a route with a single vertex is repeated. The layout is documented at
/// `talus plan`.
nlohmann::ordered_json routeGeoJson(const Route& route, const maps::ElevationMap& map,
                                    const RouteOrigin& origin);

}  // namespace talus::planner
