#pragma once

#include <string>
#include <utility>
#include <vector>

#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

/// Content of a route file of `talus plan`.
struct RouteFile {
  planner::Route route;
  /// Input files of the route.
  std::vector<InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> provenance{};  ///< the result of provenanceOf()
};

/// Returns true if the file starts like JSON or has the name of a GeoPackage; neither applies to a map.
bool looksLikeRoute(const std::string& path);

/// Returns the route of a file. @throws InputError with file and field if the file is not a route in GeoJSON
/// or GeoPackage format
RouteFile readRoute(const std::string& path);

}  // namespace talus::cli
