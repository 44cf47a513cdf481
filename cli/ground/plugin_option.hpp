#pragma once

#include <string>

#include <talus/planner/plugin/plugin_planner.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares --plugin.
void addPluginOption(CLI::App& command, std::string& plugin);

/// Declares --time, the time limit of a plugin in calls without another limit.
void addPluginTime(CLI::App& command, double& time_limit_s);

/// The planner of --plugin FILE.so and --planner; the value "field" (default of the program) selects the
/// plugin's own default.
/// @throws InputError
planner::PluginPlanner pluginOf(const std::string& plugin, const std::string& planner = {});

}  // namespace talus::cli
