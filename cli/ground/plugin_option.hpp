#pragma once

#include <string>

#include <talus/planner/plugin/plugin_planner.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares the option --plugin.
void addPluginOption(CLI::App& command, std::string& plugin);

/// Declares the option --time, the time limit of a plugin, for calls without another time limit.
void addPluginTime(CLI::App& command, double& time_limit_s);

/// Returns the planner `planner` of the shared library `plugin`. The value "field" (default of the program)
/// selects the plugin's own default planner. @throws InputError
planner::PluginPlanner pluginOf(const std::string& plugin, const std::string& planner = {});

}  // namespace talus::cli
