#pragma once

#include <string>
#include <utility>
#include <vector>

#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

/// A route file of `talus plan`.
struct RouteFile {
  planner::Route route;
  std::vector<planner::RouteInput> inputs;
  std::vector<std::pair<std::string, std::string>> provenance{};  ///< lines of provenanceOf()
};

/// Returns true if the file starts like JSON or is named as a GeoPackage; maps are neither.
bool looksLikeRoute(const std::string& path);

/// Reads a route. @throws InputError naming file and field when the file is not a route as GeoJSON or
/// GeoPackage
RouteFile readRoute(const std::string& path);

}  // namespace talus::cli
