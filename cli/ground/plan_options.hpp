#pragma once

#include <talus/cli/ground/mission.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Checks that the places and combined options of a call are consistent. @throws InputError
void requirePlaces(const PlanOptions& options);

}  // namespace talus::cli
