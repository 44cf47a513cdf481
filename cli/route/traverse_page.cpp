#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/draw/page.hpp>
#include <talus/cli/route/provenance.hpp>
#include <talus/cli/route/traverse_page.hpp>
#include <talus/cli/route/traverse_report.hpp>

namespace talus::cli {
namespace {

Scene sceneBefore(const costmap::TraversabilityMap& map, const planner::WorldResult& result,
                  planner::SoilKnowledge belief) {
  Scene scene =
      sceneOf(map, SceneOptions{.title = fmt::format("Simulated traverse: {}", label(result.drive.outcome))});
  scene.subtitle = fmt::format("soil knowledge: {}; categories before the drive", label(belief));
  const planner::TraverseSimulation& drive = result.drive;
  scene.facts = {{"outcome", label(drive.outcome)},
                 {"distance", fmt::format("{:.1f} m", drive.length_m)},
                 {"time", fmt::format("{:.0f} s", drive.time_s)},
                 {"energy", fmt::format("{:.2f} kJ", drive.energy_J / 1000.0)},
                 {"maximum slip", fmt::format("{:.2f}", drive.max_slip)},
                 {"alarms", std::to_string(drive.alarms)},
                 {"replans", std::to_string(drive.replans)},
                 {"cells reclassified", std::to_string(result.categories_changed)}};
  return scene;
}

}  // namespace

RecordedTraverse recordedTraverse(const planner::SimulationSite& site, planner::SoilKnowledge belief,
                                  const ProgressMonitor& watch) {
  const planner::TrueWorld world = site.trueWorld(0);
  costmap::TraversabilityMap map = site.estimatedMap(belief, world);
  RecordedTraverse out{{}, {{}, {}, world.patches(), map.grid()}};
  const std::vector<std::uint8_t> before = map.costs().categories().values();
  std::vector<std::uint8_t> known = before;
  planner::SimulationOptions options = site.options(belief, 0);
  options.watch = {.progress = {}, .stop = watch.stop};
  options.record = true;
  planner::TraverseLog log;
  options.on_step = [&](const planner::TraverseStep& step) { log.record(step); };
  options.on_learned = [&](double time_s) {
    std::vector<std::uint8_t> now = map.costs().categories().values();
    const int width = map.grid().width;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i] != known[i])
        out.story.changes.push_back(
            {time_s, {static_cast<int>(i) % width, static_cast<int>(i) / width}, now[i]});
    known = std::move(now);
  };
  out.result.drive = planner::simulateTraverse(map, world, options);
  for (std::size_t i = 0; i < before.size(); ++i)
    out.result.categories_changed += before[i] != known[i] ? 1U : 0U;
  out.story.drive = out.result.drive;
  out.prediction = log.errors();
  return out;
}

void saveTraversePage(const std::filesystem::path& path, const planner::SimulationSite& site,
                      planner::SoilKnowledge belief, const RecordedTraverse& drive,
                      const planner::RouteOrigin& origin) {
  Scene scene = sceneBefore(site.estimatedMap(belief, site.trueWorld(0)), drive.result, belief);
  scene.story = drive.story;
  addProvenance(scene, origin);
  savePage(path, scene);
}

}  // namespace talus::cli
