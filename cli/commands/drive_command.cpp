// talus drive DEM --truth TRUTH.yaml: simulates a traverse over soils that are unknown to the planner.
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/cli/route/traverse_report.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

using planner::kBeliefs;
using planner::SoilKnowledge;

struct DriveCommandOptions {
  GroundOptions ground;
  std::string truth, start, goal, html, telemetry, plugin, part, folder = "drive";
  std::string belief = "online";
  std::size_t worlds = 1;
  double time_limit_s = 0.0;  ///< limit per plan of a plugin; 0: no limit
  planner::SensorOptions sensors;
  std::string fault = "none", noise = "on";
};

const SoilKnowledge* findBelief(const std::string& word) {
  if (word == "perfect-knowledge") return &kBeliefs.back();
  const auto* found = std::find_if(kBeliefs.begin(), kBeliefs.end(),
                                   [&](SoilKnowledge b) { return planner::name(b) == word; });
  return found == kBeliefs.end() ? nullptr : found;
}

// Validator of --belief: returns the reason of a refusal, or an empty text.
std::string refusedBelief(const std::string& word) {
  if (word == "all" || findBelief(word) != nullptr) return "";
  return word + ", must be one of geometry, along-only, prior, online, perfect-knowledge, all";
}

void bindSensors(CLI::App& command, DriveCommandOptions& options) {
  const auto& faults = planner::sensorFaultNames();
  addOption(command, "--fault", options.fault)
      ->check(CLI::IsMember(std::vector<std::string>(faults.begin(), faults.end())));
  addOption(command, "--pose-drift SHARE", options.sensors.pose_drift)
      ->check(CLI::Range(0.0, planner::kMostPoseDrift));
  addOption(command, "--noise", options.noise)->check(CLI::IsMember({"on", "off"}));
}

planner::SensorOptions sensorsOf(const DriveCommandOptions& options) {
  planner::SensorOptions sensors = options.sensors;
  const auto& faults = planner::sensorFaultNames();
  const auto named = std::find(faults.begin(), faults.end(), options.fault);
  sensors.fault = static_cast<planner::SensorFault>(named - faults.begin());
  sensors.noise = options.noise == "on";
  return sensors;
}

void bind(CLI::App& command, DriveCommandOptions& options) {
  addGroundOptions(command, options.ground);
  addOption(command, "--truth TRUTH.yaml", options.truth)->required();
  addOption(command, "--start P", options.start)->required();
  addOption(command, "--goal P", options.goal)->required();
  addOption(command, "--belief", options.belief)
      ->check(CLI::Validator(refusedBelief, "{geometry,along-only,prior,online,perfect-knowledge,all}"));
  auto* worlds = addOption(command, "--worlds N", options.worlds)->check(CLI::Range(1, 100000));
  auto* part = addOption(command, "--part K/N", options.part)->needs(worlds);
  addOption(command, "--plugin FILE.so", options.plugin);
  addOption(command, "--time S", options.time_limit_s)->check(positive())->needs("--plugin");
  bindSensors(command, options);
  addOutput(command, "--html R.html", options.html)->excludes(worlds);
  addOutput(command, "--telemetry T.csv", options.telemetry)->excludes(worlds);
  addOption(command, "-o,--output FOLDER", options.folder)->needs(part);
}

// Simulates many worlds under one belief or all of them; JSON includes the failed worlds. Without an answer while parts
// are missing.
int runMany(const planner::SimulationSite& site, const DriveCommandOptions& options, const Campaign& campaign,
            const Ground& ground, const Context& context) {
  const bool all = options.belief == "all";
  const auto beliefs = all ? std::vector<SoilKnowledge>(kBeliefs.begin(), kBeliefs.end())
                           : std::vector<SoilKnowledge>{*findBelief(options.belief)};
  std::string identity = callText(context.argv) + sha256OfFile(options.truth);
  for (const InputFile& file : ground.files) identity += file.sha256;
  context.answerStop();
  const ProgressMonitor watch = context.watch("simulating"), inside{.progress = {}, .stop = watch.stop};
  const auto jobs = campaign.results(
      {.count = beliefs.size() * options.worlds,
       .part = options.part,
       .folder = options.folder,
       .identity = identity,
       .what = "simulations",
       .workers = static_cast<std::size_t>(context.workers())},
      [&](std::size_t k) {
        return jsonText(asJson(site.world(beliefs[k / options.worlds], k % options.worlds, inside)));
      },
      watch);
  if (!jobs) return Exit::kDone;
  const SimulatedWorlds driven = simulatedWorlds(beliefs.size(), options.worlds, *jobs);
  for (const auto& failure : driven.failures)
    context.warn(fmt::format("world {} failed and is excluded: {}", failure.world, failure.reason));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  BeliefResults results;
  std::copy(driven.results.begin(), driven.results.end(), results.begin());
  nlohmann::ordered_json json = all ? asJson(results) : asJson(results[0]);
  json["failed"] = jsonList(driven.failures, [](const auto& failure) -> nlohmann::ordered_json {
    return {{"world", failure.world}, {"reason", failure.reason}};
  });
  context.answer(json, all ? asText(results) : asText(results[0]));
  return Exit::kDone;
}

int runOne(const planner::SimulationSite& site, const DriveCommandOptions& options, const Context& context,
           const Ground& ground) {
  const SoilKnowledge belief = *findBelief(options.belief);
  context.answerStop();
  const RecordedTraverse drive = recordedTraverse(site, belief, context.watch("simulating"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const ProgressMonitor drawing = context.watch("draw");
  if (!options.html.empty()) saveTraversePage(options.html, site, belief, drive, originOf(ground, context));
  if (!options.telemetry.empty())
    saveTelemetry(options.telemetry, drive.result.drive, ground.map.model().rover());
  nlohmann::ordered_json json = asJson(drive.result);
  const planner::PredictionErrors errors = drive.log.errors();
  json["prediction"] = {{"steps", errors.steps},
                        {"slip_rmse", errors.slip_rmse},
                        {"energy_rmse", errors.energy_rmse},
                        {"energy_error", errors.energy_error}};
  context.answer(json, asText(drive.result) + fmt::format("{:<24} {}\n", "predicted", predictionText(drive)));
  return drive.result.drive.outcome == planner::Outcome::Reached ? Exit::kDone : Exit::kNo;
}

// Reads the truth and checks that its classes are classes of the map.
planner::Truth truthFor(const costmap::GroundModel& model, const std::string& path) {
  planner::Truth truth = readTruth(path);
  const auto known = [](const costmap::GroundClass& ground) { return std::to_string(ground.number); };
  for (const auto& [number, soil] : truth.classes)
    if (model.classIndex(number) < 0)
      throw InputError({path, fmt::format("class {} is not a class of the map", number),
                        "its classes are " + listText(model.parts().classes, known)});
  return truth;
}

int run(DriveCommandOptions& options, Context& context) {
  readMission(options.ground);
  const Campaign campaign;
  if (!campaign.leads()) context.quiet = true;
  checkInput(options.truth, "truth");
  Ground ground = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  std::optional<planner::PluginPlanner> plugin;
  if (!options.plugin.empty()) {
    plugin.emplace(options.plugin);
    context.threads = 1;  // the plugin forks, which a multi-threaded program must not do
  }
  const auto byPlugin = [&](planner::Problem problem) {
    if (options.time_limit_s > 0.0)
      problem.time_limit_s = std::min(problem.time_limit_s, options.time_limit_s);
    return plugin->plan(problem);
  };
  const planner::SimulationSite site(
      ground.map, {.truth = truthFor(ground.map.model(), options.truth),
                   .start = maps::readPlace(options.start, ground.map.elevation(), "--start"),
                   .goal = maps::readPlace(options.goal, ground.map.elevation(), "--goal"),
                   .firm = terramech::loadSoil("bedrock"),
                   .seed = context.seed,
                   .sensors = sensorsOf(options),
                   .planner = plugin ? byPlugin : std::function<planner::Plan(const planner::Problem&)>()});
  if (options.belief == "all" || options.worlds > 1) return runMany(site, options, campaign, ground, context);
  return campaign.leads() ? runOne(site, options, context, ground) : Exit::kDone;
}

}  // namespace

void addDrive(CLI::App& app, Context& context) {
  addCommand<DriveCommandOptions>(app, context, "drive", bind, run);
}

}  // namespace talus::cli
