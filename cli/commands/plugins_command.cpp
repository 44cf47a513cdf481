#include <talus/cli/app/command.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::cli {
namespace {

struct PluginsOptions {
  std::string file;
};

std::vector<std::string> features(const PlannerCapabilities& offers) {
  std::vector<std::string> words;
  if (offers.heading_dependent) words.emplace_back("heading-dependent cost");
  if (offers.lower_bound) words.emplace_back("lower bound");
  if (offers.via_points) words.emplace_back("via points");
  if (offers.several_goals) words.emplace_back("several goals");
  if (offers.headings) words.emplace_back("headings");
  if (offers.turning_radius) words.emplace_back("turning radius");
  if (offers.reversing) words.emplace_back("reversing");
  if (offers.chassis) words.emplace_back("chassis");
  if (offers.risk_limit) words.emplace_back("risk limit");
  if (offers.incremental_update) words.emplace_back("incremental update");
  if (offers.deterministic) words.emplace_back("deterministic");
  return words;
}

int run(const PluginsOptions& options, Context& context) {
  PlannerCapabilities offers{
      .name = "talus (built-in)", .version = TALUS_VERSION, .planners = planner::plannerNames()};
  if (!options.file.empty()) offers = planner::loadPlugin(options.file)->capabilities();
  if (context.json) {
    printJson(
        {{"file", options.file.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(options.file)},
         {"name", offers.name},
         {"version", offers.version},
         {"interface_version", offers.interface_version},
         {"planners", offers.planners},
         {"features", features(offers)}});
    return Exit::kDone;
  }
  print(fmt::format("{} {}, planner interface {}\n", offers.name, offers.version, offers.interface_version));
  if (!offers.planners.empty()) print(fmt::format("planners: {}\n", fmt::join(offers.planners, ", ")));
  if (const auto words = features(offers); !words.empty())
    print(fmt::format("features: {}\n", fmt::join(words, ", ")));
  return Exit::kDone;
}

void bind(CLI::App& app, PluginsOptions& options) {
  addOption(app, "file", options.file);
}

}  // namespace

void addPlugins(CLI::App& app, Context& context) {
  addCommand<PluginsOptions>(app, context, "plugins", bind, run);
}

}  // namespace talus::cli
