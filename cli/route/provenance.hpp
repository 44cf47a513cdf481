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

/// The call as a shell command, without arguments that do not affect results: outputs, --threads, --json,
/// --quiet and --force. Empty without arguments.
std::string callText(const char* const* argv);

/// Lines of a route's "inputs": command, rover, soil, files with their SHA-256, seed, version.
std::vector<std::pair<std::string, std::string>> provenanceOf(const nlohmann::ordered_json& inputs);

/// Origin of results on this ground: files with their SHA-256, seed, rover, soils, and the call.
planner::RouteOrigin originOf(const Ground& ground, const Context& context);

/// Adds the origin to a page or picture and removes the facts that it repeats.
void addProvenance(Scene& scene, const planner::RouteOrigin& origin);

}  // namespace talus::cli
