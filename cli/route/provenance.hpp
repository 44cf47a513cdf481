#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace talus::cli {

/// The words of a call as a shell takes them, without those that decide no number: outputs, --threads, --json, --quiet and
/// --force. Empty without words.
std::string callText(const char* const* argv);

/// What a route's "inputs" state, a line each: command, rover, soil, files with their SHA-256, seed, version.
std::vector<std::pair<std::string, std::string>> provenanceOf(const nlohmann::ordered_json& inputs);

}  // namespace talus::cli
