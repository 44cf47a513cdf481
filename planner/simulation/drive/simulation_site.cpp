#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::planner {
namespace {

using costmap::Hazard;

maps::Raster<std::uint8_t> classIndices(const costmap::TraversabilityMap& map) {
  maps::Raster<std::uint8_t> index(map.grid());
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column)
      index[{column, row}] = static_cast<std::uint8_t>(std::max(map.surface().classIndex({column, row}), 0));
  return index;
}

// Hazards declared by layers; hazards of the surface are computed again.
maps::Raster<Hazard> declaredHazards(const costmap::TraversabilityMap& map) {
  constexpr auto kDeclared = static_cast<std::uint8_t>(Hazard::Rocks | Hazard::KeepOut | Hazard::Obstacle);
  maps::Raster<Hazard> hazards = map.surface().hazards();
  for (Hazard& h : hazards.values()) h = static_cast<Hazard>(static_cast<std::uint8_t>(h) & kDeclared);
  return hazards;
}

// Makes every soil of the world a class of its own with negligible uncertainty. A cell belongs to a patch if
// a wheel of a rover anywhere on the cell may touch the patch.
void setTrueSoils(const TrueWorld& world, double footprint_m, costmap::MapLayers& layers,
                  costmap::GroundModel::Parts& parts) {
  constexpr double kExactStd = 0.01;
  parts.classes.clear();
  for (const terramech::Soil& soil : world.soils())
    parts.classes.push_back({.number = static_cast<int>(parts.classes.size()),
                             .soil = soil,
                             .effects = world.effects(),
                             .pull_std = kExactStd,
                             .mean_std = kExactStd});
  const maps::Grid& grid = layers.elevation.grid();
  const double reach_m = footprint_m + grid.resolution_m * std::sqrt(0.5);
  layers.classes = maps::Raster<std::uint8_t>(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.classes[{column, row}] =
          static_cast<std::uint8_t>(world.soilAt(grid.centre({column, row}), reach_m));
}

}  // namespace

std::string_view name(SoilKnowledge belief) noexcept {
  constexpr std::string_view kNames[] = {"geometry", "along-only", "prior", "online", "clairvoyant"};
  return kNames[static_cast<int>(belief)];
}

SimulationSite::SimulationSite(const costmap::TraversabilityMap& map, Parts parts)
    : map_(map), parts_(std::move(parts)) {}

TrueWorld SimulationSite::trueWorld(std::size_t i) const {
  return {drawWorld(parts_.truth, map_.model().parts().classes, map_.grid(),
                    {.seed = parts_.seed + i, .start = parts_.start, .goal = parts_.goal}),
          map_.model().rover(), classIndices(map_)};
}

costmap::TraversabilityMap SimulationSite::estimatedMap(SoilKnowledge belief, const TrueWorld& world) const {
  costmap::GroundModel::Parts parts = map_.model().parts();
  costmap::MapLayers layers{map_.elevation(), map_.surface().classes(), {}, {}, declaredHazards(map_)};
  layers.costs = map_.surface().costLayers();
  if (belief == SoilKnowledge::Geometry)
    for (costmap::GroundClass& ground : parts.classes) {
      ground.soil = parts_.firm;
      ground.effects.clear();
    }
  parts.prices_crossing = belief != SoilKnowledge::AlongOnly;
  if (belief == SoilKnowledge::PerfectKnowledge)
    setTrueSoils(world, map_.surface().footprintRadius_m(), layers, parts);
  return {std::move(layers),
          std::make_shared<costmap::GroundModel>(std::move(parts)),
          {.footprint_radius_m = map_.surface().footprintRadius_m(), .threads = 1}};
}

SimulationOptions SimulationSite::options(SoilKnowledge belief, std::size_t i) const {
  SensorOptions sensors = parts_.sensors;
  sensors.seed = parts_.seed + i;
  sensors.second_slip = parts_.truth.second_slip;
  if (belief == SoilKnowledge::PerfectKnowledge)
    sensors.pose_drift = 0.0;  // the position is known exactly, too
  return {.start = parts_.start,
          .goal = parts_.goal,
          .goal_tolerance_m = map_.grid().resolution_m,
          .senses = belief == SoilKnowledge::OnLine,
          .sensors = sensors,
          .planner = parts_.planner};
}

WorldResult SimulationSite::world(SoilKnowledge belief, std::size_t i, const ProgressMonitor& watch) const {
  const TrueWorld truth = trueWorld(i);
  costmap::TraversabilityMap map = estimatedMap(belief, truth);
  const std::vector<std::uint8_t> before = map.costs().categories().values();
  SimulationOptions how = options(belief, i);
  how.watch = {.progress = {}, .stop = watch.stop};
  WorldResult result{simulateTraverse(map, truth, how)};
  const std::vector<std::uint8_t> after = map.costs().categories().values();
  for (std::size_t c = 0; c < before.size(); ++c)
    result.categories_changed += before[c] != after[c] ? 1U : 0U;
  return result;
}

std::vector<WorldResult> SimulationSite::worlds(const WorldRange& range, const ProgressMonitor& watch) const {
  std::vector<WorldResult> results;
  for (std::size_t i = 0; i < range.count && !watch.stopped(); ++i) {
    results.push_back(world(range.belief, range.first + i, watch));
    watch.report(static_cast<double>(i + 1) / static_cast<double>(range.count));
  }
  return results;
}

}  // namespace talus::planner
