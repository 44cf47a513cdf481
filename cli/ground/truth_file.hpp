#pragma once

#include <string>

#include <talus/planner/simulation/simulation.hpp>

namespace talus::cli {

/// Description of the format of TRUTH.yaml (true soils of a simulation) for the help.
extern const char* const kTruthFormat;

/// Returns the content of a truth file. Throws InputError with file, line and field.
planner::Truth readTruth(const std::string& path);

}  // namespace talus::cli
