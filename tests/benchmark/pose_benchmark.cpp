// Drives with a turning radius: CPU time from a cost grid to a checked drive, field included, on generated
// sites of 150 k cells with soils and slopes, Reeds-Shepp curves at 72 headings. One thread; only times of
// one run are comparable.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/sites/site_generator.hpp>
#include <talus/planner/pose/hybrid_search.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace {

using namespace talus;
using namespace talus::planner;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

constexpr int kSide = 388;  // 150,544 cells
constexpr double kResolution_m = 0.25;

MapPointer site(maps::SiteKind kind) {
  costmap::GroundModel::Parts parts;
  parts.rover = terramech::loadRover("mer");
  const std::array soils{std::pair{maps::SiteClass::Firm, "mars_crusty"},
                         std::pair{maps::SiteClass::Loose, "sand"},
                         std::pair{maps::SiteClass::VeryLoose, "mars_drift"}};
  for (const auto& [number, soil] : soils)
    parts.classes.push_back(
        costmap::groundClass(static_cast<int>(number), terramech::loadSoilPrior(soil), parts.rover));
  maps::Site made = maps::generateSite(
      {.kind = kind, .width = kSide, .height = kSide, .resolution_m = kResolution_m, .seed = 1});
  costmap::MapLayers layers;
  layers.elevation = std::move(made.map);
  layers.classes = std::move(made.classes);
  layers.rock_abundance = std::move(made.rock_abundance);
  return costmap::TraversabilityMap(std::move(layers),
                                    std::make_shared<const costmap::GroundModel>(std::move(parts)), {})
      .published();
}

// Starts and goals at least half the map apart, with random headings.
std::vector<PoseProblem> problemsOn(const MapPointer& map, int count) {
  std::mt19937_64 random(5);
  const auto unit = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double side_m = kSide * kResolution_m;
  const MotionCost cost(map);
  std::vector<PoseProblem> problems;
  while (static_cast<int>(problems.size()) < count) {
    PoseProblem asked{.map = map,
                      .start = {side_m * unit(), side_m * unit()},
                      .goal = {side_m * unit(), side_m * unit()},
                      .start_heading_rad = 2.0 * std::numbers::pi * unit(),
                      .goal_heading_rad = 2.0 * std::numbers::pi * unit(),
                      .kinematics = {.turning_radius_m = 1.0},
                      .watch = {}};
    const double apart_m = std::hypot(asked.goal.x_m - asked.start.x_m, asked.goal.y_m - asked.start.y_m);
    if (apart_m < 0.5 * side_m || !cost.allowed(asked.start) || !cost.allowed(asked.goal)) continue;
    if (HybridSearch().plan(asked).status == RouteStatus::Found) problems.push_back(asked);
  }
  return problems;
}

void drive(benchmark::State& state, maps::SiteKind kind) {
  const auto problems = problemsOn(site(kind), 10);
  std::uint64_t expanded = 0;
  double cost_J = 0.0;
  std::size_t k = 0;
  for (auto _ : state) {
    HybridSearch search;
    const PosePlan plan = search.plan(problems[k++ % problems.size()]);
    expanded += plan.expanded;
    cost_J += plan.cost_J;
  }
  state.counters["expanded"] =
      benchmark::Counter(static_cast<double>(expanded), benchmark::Counter::kAvgIterations);
  state.counters["cost_J"] = benchmark::Counter(cost_J, benchmark::Counter::kAvgIterations);
}

BENCHMARK_CAPTURE(drive, craters, maps::SiteKind::Craters)->Unit(benchmark::kMillisecond)->Iterations(50);
BENCHMARK_CAPTURE(drive, dunes, maps::SiteKind::Dunes)->Unit(benchmark::kMillisecond)->Iterations(50);
BENCHMARK_CAPTURE(drive, rocks, maps::SiteKind::Rocks)->Unit(benchmark::kMillisecond)->Iterations(50);

}  // namespace
