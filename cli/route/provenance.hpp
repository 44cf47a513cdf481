#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

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

}  // namespace talus::cli
