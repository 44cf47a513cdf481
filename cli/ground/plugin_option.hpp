#pragma once

#include <string>

#include <talus/planner/plugin/plugin_planner.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

/// Declares --plugin.
void addPluginOption(CLI::App& command, std::string& plugin);

/// Declares --time of a plugin that plans for a call that sets no other limit.
void addPluginTime(CLI::App& command, double& time_limit_s);

/// The planner of --plugin FILE.so and --planner; "field", the program's default, is the plugin's own default.
/// @throws InputError
planner::PluginPlanner pluginOf(const std::string& plugin, const std::string& planner = {});

}  // namespace talus::cli
