#pragma once

#include <string>

#include <talus/planner/simulation/worlds/world_draw.hpp>

namespace talus::cli {

/// Description of the format of TRUTH.yaml for the help.
extern const char* const kTruthFormat;

/// Reads a truth file. Throws InputError with file, line and field.
planner::Truth readTruth(const std::string& path);

}  // namespace talus::cli
