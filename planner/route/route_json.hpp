#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/maps.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Data with which a route can be computed again.
struct RouteOrigin {
  std::vector<InputFile> files;      ///< files that the planner read; paths as given to it
  std::uint64_t seed = 1;            ///< seed of the planner
  std::string rover{};               ///< name of the rover
  std::vector<std::string> soils{};  ///< names of the soils, one per terrain class of the map
  std::string reading{};             ///< how the heights were read (ElevationMap); empty if unknown
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
