#pragma once

#include <talus/cli/ground/mission.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Checks that positions and options of a call are consistent with each other. @throws InputError otherwise
void requirePlaces(const PlanOptions& options);

}  // namespace talus::cli
