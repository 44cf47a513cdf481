// talus drive DEM --truth TRUTH.yaml: rehearse a traverse over soils that the planner does not know.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cli/command.hpp>
#include <cli/commands.hpp>
#include <cli/drive_world.hpp>
#include <cli/ground_options.hpp>
#include <maps/place_reader.hpp>
#include <planner/rehearsal.hpp>
#include <terramech/soil_library.hpp>

namespace talus::cli {
namespace {

struct Options {
  GroundOptions ground;
  std::string truth, start, goal;
  std::string belief = "online";
  int worlds = 1;
};

void bind(CLI::App& command, Options& options) {
  addGroundOptions(command, options.ground);
  command.add_option("--truth", options.truth, "true soils, patches, random spread")
      ->required()
      ->type_name("TRUTH.yaml");
  command.add_option("--start", options.start, "where to start")->required()->type_name("P");
  command.add_option("--goal", options.goal, "where to go")->required()->type_name("P");
  command.add_option("--belief", options.belief, "what the rover goes by")
      ->check(CLI::IsMember({"geometry", "prior", "online", "clairvoyant"}))
      ->capture_default_str();
  command.add_option("--worlds", options.worlds, "rehearse in so many random worlds, two at a time")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
}

// What every world starts from.
struct Site {
  const costmap::TraversabilityMap& map;
  maps::Raster<std::uint8_t> class_index;  // of the true classes
  Truth truth;
  maps::Point start, goal;
};

maps::Raster<std::uint8_t> indexRaster(const costmap::TraversabilityMap& map) {
  maps::Raster<std::uint8_t> index(map.grid());
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column)
      index[{column, row}] = static_cast<std::uint8_t>(std::max(map.classIndex({column, row}), 0));
  return index;
}

maps::Raster<costmap::Hazard> siteHazards(const costmap::TraversabilityMap& map) {
  maps::Raster<costmap::Hazard> hazards = map.hazards();
  for (costmap::Hazard& h : hazards.values())
    h = static_cast<costmap::Hazard>(static_cast<std::uint8_t>(h) &
                                     static_cast<std::uint8_t>(costmap::Hazard::Rocks |
                                                               costmap::Hazard::KeepOut |
                                                               costmap::Hazard::Obstacle));
  return hazards;
}

// The map that the rover goes by: slopes alone, the map's own soils, or the truth, patches and all.
costmap::TraversabilityMap believed(const Site& site, const std::string& belief,
                                    const planner::WorldSoils& world, const planner::TrueWorld& truth) {
  costmap::GroundModel::Parts parts = site.map.model().parts();
  costmap::MapLayers layers{site.map.elevation(), site.map.classes(), {}, {}, siteHazards(site.map)};
  if (belief == "geometry")
    for (costmap::GroundClass& ground : parts.classes) ground.soil = terramech::loadSoil("bedrock");
  if (belief == "clairvoyant") {
    layers.classes = maps::Raster<std::uint8_t>(site.map.grid());
    for (int row = 0; row < site.map.grid().height; ++row)
      for (int column = 0; column < site.map.grid().width; ++column)
        layers.classes[{column, row}] = static_cast<std::uint8_t>(
            std::min<std::size_t>(truth.soilAt(site.map.grid().centre({column, row})), world.classes.size()));
    parts.classes.clear();
    for (std::size_t i = 0; i < world.classes.size(); ++i)
      parts.classes.push_back(
          {.number = static_cast<int>(i), .soil = world.classes[i], .pull_std = 0.01, .mean_std = 0.01});
    if (!world.patches.empty())
      parts.classes.push_back({.number = static_cast<int>(world.classes.size()),
                               .soil = world.patches.back().soil,
                               .pull_std = 0.01,
                               .mean_std = 0.01});
  }
  return {std::move(layers),
          std::make_shared<costmap::GroundModel>(std::move(parts)),
          {.footprint_radius_m = site.map.footprintRadius_m(), .threads = 1}};
}

struct WorldResult {
  planner::Rehearsal drive;
  std::size_t categories_changed = 0;
};

WorldResult rehearseWorld(const Site& site, const std::string& belief, std::uint64_t seed,
                          const Watch& watch) {
  const planner::WorldSoils soils =
      drawWorld(site.truth, site.map, {.seed = seed, .keep_start = site.start, .keep_goal = site.goal});
  const planner::TrueWorld world(soils, site.map.model().rover(), site.class_index);
  costmap::TraversabilityMap map = believed(site, belief, soils, world);
  const auto categories = [&] {
    std::vector<std::uint8_t> out;
    for (int row = 0; row < map.grid().height; ++row)
      for (int column = 0; column < map.grid().width; ++column) out.push_back(map.category({column, row}));
    return out;
  };
  const auto before = categories();
  planner::RehearsalOptions options;
  options.start = site.start;
  options.goal = site.goal;
  options.goal_tolerance_m = site.map.grid().resolution_m;
  options.senses = belief == "online";
  options.seed = seed;
  options.watch = watch;
  WorldResult result{planner::rehearse(map, world, options)};
  const auto after = categories();
  for (std::size_t i = 0; i < before.size(); ++i)
    result.categories_changed += before[i] != after[i] ? 1U : 0U;
  return result;
}

nlohmann::ordered_json asJson(const WorldResult& result) {
  return {{"outcome", planner::name(result.drive.outcome)},
          {"energy_J", result.drive.energy_J},
          {"length_m", result.drive.length_m},
          {"time_s", result.drive.time_s},
          {"replans", result.drive.replans},
          {"max_slip", result.drive.max_slip},
          {"categories_changed", result.categories_changed}};
}

// Wilson's 95 % interval of a share.
std::array<double, 2> interval(std::size_t hits, std::size_t all) {
  constexpr double z = 1.959963984540054;
  const double n = static_cast<double>(all), p = static_cast<double>(hits) / n;
  const double middle = p + z * z / (2.0 * n),
               half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {std::max((middle - half) / (1.0 + z * z / n), 0.0),
          std::min((middle + half) / (1.0 + z * z / n), 1.0)};
}

nlohmann::ordered_json asJson(const std::vector<WorldResult>& results) {
  nlohmann::ordered_json out{{"worlds", results.size()}};
  for (const auto outcome : {planner::Outcome::Reached, planner::Outcome::Immobilised,
                             planner::Outcome::Tipped, planner::Outcome::GaveUp}) {
    const auto hits = static_cast<std::size_t>(std::count_if(
        results.begin(), results.end(), [&](const WorldResult& r) { return r.drive.outcome == outcome; }));
    out[std::string(planner::name(outcome))] = {
        {"rate", static_cast<double>(hits) / static_cast<double>(results.size())},
        {"interval_95", interval(hits, results.size())}};
  }
  double energy = 0.0, reached = 0.0;
  nlohmann::ordered_json each = nlohmann::ordered_json::array();
  for (const WorldResult& r : results) {
    if (r.drive.outcome == planner::Outcome::Reached) {
      energy += r.drive.energy_J;
      reached += 1.0;
    }
    each.push_back(asJson(r));
  }
  out["mean_energy_J_where_reached"] = reached > 0.0 ? energy / reached : std::nan("");
  out["each"] = each;
  return out;
}

std::vector<WorldResult> rehearseAll(const Site& site, const Options& options, const Context& context) {
  std::vector<WorldResult> results(static_cast<std::size_t>(options.worlds));
  Watch watch;
  watch.stop = context.stop;
  const auto work = [&](std::size_t first, std::size_t stride) {
    for (std::size_t i = first; i < results.size() && !watch.stopped(); i += stride)
      results[i] = rehearseWorld(site, options.belief, context.seed + i, watch);
  };
  const std::size_t workers =
      std::min<std::size_t>(static_cast<std::size_t>(std::max(context.workers(), 1)), 2);
  std::vector<std::jthread> threads;
  for (std::size_t t = 1; t < workers; ++t) threads.emplace_back(work, t, workers);
  work(0, workers);
  return results;
}

int run(const Options& options, Context& context) {
  const Ground ground = readGround(options.ground, context);
  Site site{ground.map, indexRaster(ground.map), readTruth(options.truth), {}, {}};
  site.start = maps::readPlace(options.start, ground.map.elevation(), "--start");
  site.goal = maps::readPlace(options.goal, ground.map.elevation(), "--goal");
  const std::vector<WorldResult> results = rehearseAll(site, options, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const nlohmann::ordered_json json = options.worlds == 1 ? asJson(results.front()) : asJson(results);
  if (context.json)
    printJson(json);
  else
    for (const auto& [key, value] : json.items())
      if (key != "each") print(fmt::format("{:<28} {}\n", key, value.dump()));
  const bool reached = results.front().drive.outcome == planner::Outcome::Reached;
  return options.worlds > 1 || reached ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addDrive(CLI::App& app, Context& context) {
  addCommand<Options>(
      app, context,
      {.name = "drive",
       .group = Group::kRoutes,
       .description = "rehearse: drive the route over soils that the planner does not know",
       .examples =
           "  talus drive dem.tif --truth truth.yaml --start 10,10 --goal 90,90\n"
           "  talus drive dem.tif --truth truth.yaml --start 10,10 --goal 90,90 --worlds 100 --belief "
           "prior\n"},
      bind, run);
}

}  // namespace talus::cli
