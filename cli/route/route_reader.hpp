#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/maps.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

struct Context;
struct Ground;
struct Scene;

/// Returns the call of the program as a shell command, without arguments that do not affect results: outputs,
/// --threads, --json, --quiet and --force. Returns an empty text for a call without arguments.
std::string callText(const char* const* argv);

/// Returns the lines of the provenance of a route from its member "inputs": command, rover, soil, files with
/// their SHA-256, seed, version.
std::vector<std::pair<std::string, std::string>> provenanceOf(const nlohmann::ordered_json& inputs);

/// Returns the origin of results on this ground: files with their SHA-256, seed, rover, soils, and the call.
planner::RouteOrigin originOf(const Ground& ground, const Context& context);

/// Adds the origin of the results to a page or picture, and removes facts that the origin repeats.
void addProvenance(Scene& scene, const planner::RouteOrigin& origin);

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
