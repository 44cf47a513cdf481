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

/// The words of a call as a shell takes them, without those that decide no number: outputs, --threads, --json, --quiet and
/// --force. Empty without words.
std::string callText(const char* const* argv);

/// What a route's "inputs" state, a line each: command, rover, soil, files with their SHA-256, seed, version.
std::vector<std::pair<std::string, std::string>> provenanceOf(const nlohmann::ordered_json& inputs);

/// What a call on this ground is made from: its files with their SHA-256, seed, rover, soils, and the call.
planner::RouteOrigin originOf(const Ground& ground, const Context& context);

/// States the origin on a page or picture, in place of the facts that it repeats.
void addProvenance(Scene& scene, const planner::RouteOrigin& origin);

}  // namespace talus::cli
