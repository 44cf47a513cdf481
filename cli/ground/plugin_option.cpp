#include <CLI/CLI.hpp>

#include <talus/cli/ground/plugin_option.hpp>

namespace talus::cli {

void addPluginOption(CLI::App& command, std::string& plugin) {
  command
      .add_option("--plugin", plugin,
                  "plan by a planner plugin instead; its route is checked, and the cost is the program's own")
      ->type_name("FILE.so");
}

planner::PluginPlanner pluginOf(const std::string& plugin, const std::string& planner) {
  return planner::PluginPlanner(plugin, planner == "field" ? std::string() : planner);
}

}  // namespace talus::cli
