#include <CLI/CLI.hpp>

#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/plugin_option.hpp>

namespace talus::cli {

void addPluginOption(CLI::App& command, std::string& plugin) {
  command
      .add_option("--plugin", plugin,
                  "plan by a planner plugin instead; its route is checked, and the cost is the program's own")
      ->type_name("FILE.so");
}

void addPluginTime(CLI::App& command, double& time_limit_s) {
  command
      .add_option("--time", time_limit_s,
                  "time limit of the plugin for each plan, which it is ended a second after (default: none)")
      ->type_name("S")
      ->check(positive())
      ->needs(command.get_option("--plugin"));
}

planner::PluginPlanner pluginOf(const std::string& plugin, const std::string& planner) {
  return planner::PluginPlanner(plugin, planner == "field" ? std::string() : planner);
}

}  // namespace talus::cli
