#pragma once

#include <talus/cli/ground/mission.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares the option --plugin.
void addPluginOption(CLI::App& command, std::string& plugin);

/// Declares the option --time, the time limit of a plugin, for calls without another time limit.
void addPluginTime(CLI::App& command, double& time_limit_s);

/// Declares the options of `talus plan`.
void bindPlan(CLI::App& command, PlanOptions& options);

/// Checks that positions and options of a call are consistent with each other. @throws InputError otherwise
void requirePlaces(const PlanOptions& options);

}  // namespace talus::cli
