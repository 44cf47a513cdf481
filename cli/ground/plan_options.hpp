#pragma once

#include <talus/cli/ground/mission.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Whether the places asked for, and what is combined, make a call. @throws InputError
void requirePlaces(const PlanOptions& options);

}  // namespace talus::cli
