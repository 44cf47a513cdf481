#pragma once

#include <string>
#include <utility>
#include <vector>

#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

/// A route as `talus plan` wrote it.
struct RouteFile {
  planner::Route route;
  std::vector<planner::RouteInput> inputs;
  std::vector<std::pair<std::string, std::string>> provenance{};  ///< as provenanceOf() states it
};

/// Whether the file starts like JSON or is named as a GeoPackage, as a route does and no map.
bool looksLikeRoute(const std::string& path);

/// Reads a route back. @throws InputError naming file and field when it is no such GeoJSON or GeoPackage
RouteFile readRoute(const std::string& path);

}  // namespace talus::cli
