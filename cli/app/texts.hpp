#pragma once

#include <span>
#include <string>

#include <talus/terramech/io/yaml_fields.hpp>

namespace YAML {
class Node;
}

namespace talus::cli {

/// Returns the texts of the help, which are those of cli/app/texts.yaml: `calls` and `formats`.
const YAML::Node& texts();

/// Returns the keys of a file format with their meanings, by the title of the format in texts.yaml.
std::span<const terramech::FileKey> keysOf(const std::string& format);

}  // namespace talus::cli
