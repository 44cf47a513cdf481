#pragma once

#include <string>
#include <vector>

#include <talus/planner/route/route.hpp>

namespace talus::cli {

/// A file that a route was made from.
struct RouteInput {
  std::string file;  ///< its name without the folder
  std::string
      path;  ///< as it was given to the planner, relative to its folder; empty where the route has none
  std::string sha256;  ///< of its content, hexadecimal
};

/// A route as `talus plan` wrote it.
struct RouteFile {
  planner::Route route;
  std::vector<RouteInput> inputs;
};

/// Whether the file starts like JSON, as a route does and no map.
bool looksLikeJson(const std::string& path);

/// Reads a route back. @throws InputError naming file and field when it is no such GeoJSON
RouteFile readRoute(const std::string& path);

}  // namespace talus::cli
