#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <talus/planner/simulation/simulation.hpp>

namespace talus::planner {

namespace {

constexpr double kNormal95 = 1.959963984540054;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool reached(const WorldResult& result) {
  return result.drive.outcome == Outcome::Reached;
}

}  // namespace

Sampled share(std::size_t hits, std::size_t all) {
  if (all == 0) return {kNone, {kNone, kNone}};
  const double n = static_cast<double>(all), p = static_cast<double>(hits) / n, zz = kNormal95 * kNormal95;
  const double middle = p + zz / (2.0 * n);
  const double half = kNormal95 * std::sqrt(p * (1.0 - p) / n + zz / (4.0 * n * n));
  const double low = (middle - half) / (1.0 + zz / n), high = (middle + half) / (1.0 + zz / n);
  return {p, {hits == 0 ? 0.0 : low, hits == all ? 1.0 : high}};  // exact, because rounding leaves 1e-17
}

Sampled mean(const std::vector<double>& values) {
  if (values.empty()) return {kNone, {kNone, kNone}};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  const double half = n > 1.0 ? kNormal95 * std::sqrt(squares / (n - 1.0) / n) : kNone;
  return {sum / n, {sum / n - half, sum / n + half}};
}

Rates ratesOf(const std::vector<WorldResult>& results) {
  Rates rates{.worlds = results.size(), .outcome = {}, .energy_J = 0.0};
  for (std::size_t o = 0; o < rates.outcome.size(); ++o) {
    const auto hits = std::count_if(results.begin(), results.end(), [o](const WorldResult& r) {
      return r.drive.outcome == static_cast<Outcome>(o);
    });
    rates.outcome[o] = share(static_cast<std::size_t>(hits), results.size());
  }
  std::vector<double> energies;
  for (const WorldResult& r : results)
    if (reached(r)) energies.push_back(r.drive.energy_J);
  rates.energy_J = mean(energies).value;
  return rates;
}

Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect) {
  if (results.size() != perfect.size())
    throw std::invalid_argument("compared: " + std::to_string(results.size()) + " worlds against " +
                                std::to_string(perfect.size()) + ", must be as many");
  std::vector<WorldResult> passable;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!reached(perfect[i])) continue;
    passable.push_back(results[i]);
    if (reached(results[i])) ratios.push_back(results[i].drive.energy_J / perfect[i].drive.energy_J);
  }
  return {ratesOf(passable), mean(ratios)};
}

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

PredictionErrors TraverseLog::errors() const {
  PredictionErrors e{.steps = static_cast<int>(steps_.size())};
  double slip = 0.0, energy = 0.0, expected_J = 0.0, true_J = 0.0, length_m = 0.0;
  for (const TraverseStep& s : steps_) {
    const double surface_m = s.length_m * std::hypot(1.0, s.gradient);
    slip += std::pow(s.expected_slip - s.truth.slip, 2);
    energy += std::pow(s.expected_energy_J_per_m - s.truth.energy_J_per_m, 2);
    expected_J += s.expected_energy_J_per_m * surface_m;
    true_J += s.truth.energy_J_per_m * surface_m;
    length_m += surface_m;
  }
  if (steps_.empty() || true_J <= 0.0) return e;
  const auto n = static_cast<double>(steps_.size());
  e.slip_rmse = std::sqrt(slip / n);
  e.energy_rmse = std::sqrt(energy / n) / (true_J / length_m);
  e.energy_error = expected_J / true_J - 1.0;
  return e;
}

}  // namespace talus::planner
