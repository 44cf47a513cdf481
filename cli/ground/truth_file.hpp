#pragma once

#include <string>

#include <talus/planner/simulation/worlds/world_draw.hpp>

namespace talus::cli {

/// What TRUTH.yaml may hold, for the help of the program.
extern const char* const kTruthFormat;

/// Reads a truth file. Throws InputError naming file, line and field.
planner::Truth readTruth(const std::string& path);

}  // namespace talus::cli
