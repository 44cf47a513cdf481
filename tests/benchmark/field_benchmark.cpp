// The field planner by its parts, on rolling ground with blocked cells. Ratios within one run are what to
// compare.
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include <benchmark/benchmark.h>

#include <planner/any_angle.hpp>
#include <planner/field_planner.hpp>

namespace {

using namespace talus;
using namespace talus::planner;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

std::shared_ptr<const costmap::DriveCost> driveCost() {
  std::vector<costmap::DriveCurve> curves(5);
  for (std::size_t k = 0; k < curves.size(); ++k)
    for (int bin = 0; bin < costmap::DriveCurve::kBins; ++bin) {
      const double g = costmap::DriveCurve::gradient(bin);
      curves[k].cost_J_per_m[static_cast<std::size_t>(bin)] = static_cast<float>(
          (1.0 + static_cast<double>(k)) * (10.0 + 100.0 * std::fmax(g, 0.0) + 400.0 * g * g));
    }
  return std::make_shared<costmap::DriveCost>(costmap::DriveCost::Limits{.max_along = 0.3, .max_across = 0.3},
                                              curves);
}

// Waves of twenty lengths from 9 to 600 cells, soils in patches, one cell in fifty blocked.
MapPointer rollingGround(int side) {
  static std::map<int, MapPointer> made;
  if (made.contains(side)) return made[side];
  std::mt19937 random(3);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 20; ++k) {
    const double number = 0.01 * std::pow(1.25, k), angle = 6.28 * unit();
    waves.push_back({number * std::cos(angle), number * std::sin(angle), 6.28 * unit()});
  }
  maps::Raster<costmap::CellCode> cells(
      {.width = side, .height = side, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      costmap::CellCode::Parts cell;
      for (const Wave& wave : waves) {
        const double slope =
            0.035 * std::cos(wave.x * column + wave.y * row + wave.phase) / std::hypot(wave.x, wave.y);
        cell.dz_dx += slope * wave.x;
        cell.dz_dy += slope * wave.y;
      }
      cell.curve = static_cast<std::uint8_t>((std::sin(0.013 * column) + std::sin(0.017 * row) + 2.0) * 1.2);
      if (unit() < 0.02) cell.curve = costmap::CellCode::kBlocked;
      cells[{column, row}] = costmap::CellCode(cell);
    }
  return made[side] = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, driveCost()));
}

void perCell(benchmark::State& state, const costmap::CostGrid& map) {
  const auto cells = static_cast<double>(map.grid().size());
  state.counters["cells/s"] = benchmark::Counter(cells, benchmark::Counter::kIsIterationInvariantRate);
}

void edgeLayer(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  const EdgeUnits units(map->cost(), 1.0);
  const auto kernels = state.range(1) == 0 ? Kernels::Best : Kernels::Scalar;
  for (auto _ : state) benchmark::DoNotOptimize(EdgeLayer(map, units, 1, StopCheck{}, kernels).complete());
  perCell(state, *map);
}

void wholeField(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  const auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0));
  const auto kernels = state.range(1) == 0 ? Kernels::Best : Kernels::Scalar;
  for (auto _ : state) {
    CostToGo field(edges, {{.cell = {edges->padded().width / 10, edges->padded().height / 10}}}, kernels);
    benchmark::DoNotOptimize(field.settleAll());
  }
  perCell(state, *map);
}

Problem across(const MapPointer& map) {
  const double side = map->grid().width;
  return {.map = map, .start = {0.1 * side, 0.1 * side}, .goal = {0.9 * side, 0.95 * side}, .prove = false};
}

void layersToRoute(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  auto problem = across(map);
  problem.threads = static_cast<int>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(FieldPlanner().plan(problem).cost_J);
}

void lowerBound(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  auto problem = across(map);
  const double cost_J = FieldPlanner().plan(problem).cost_J;
  double bound_J = 0.0;
  for (auto _ : state) bound_J = LowerBound()(map, {problem.start, problem.goal}, 0.0);
  state.counters["gap"] = cost_J / bound_J - 1.0;
}

void anotherStart(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  auto problem = across(map);
  FieldPlanner planner;
  planner.plan(problem);
  for (auto _ : state) {
    problem.start.x_m += 1.0;
    benchmark::DoNotOptimize(planner.plan(problem).cost_J);
  }
}

// The map with one soil changed in 200x200 cells at a share of the way.
MapPointer patched(const MapPointer& map, maps::Point middle) {
  auto content = map->content();
  const int columns = map->tileColumns();
  std::map<std::size_t, std::shared_ptr<costmap::CostTile>> own;
  for (int row = static_cast<int>(middle.y_m) - 100; row < static_cast<int>(middle.y_m) + 100; ++row)
    for (int column = static_cast<int>(middle.x_m) - 100; column < static_cast<int>(middle.x_m) + 100;
         ++column) {
      if (!map->grid().contains({column, row})) continue;
      const auto t = static_cast<std::size_t>((row >> 6) * columns + (column >> 6));
      if (!own[t]) {
        own[t] = std::make_shared<costmap::CostTile>(content.tiles.tile(t));
        content.tiles.set(t, own[t]);
      }
      auto& cell = own[t]->cells[static_cast<std::size_t>((row & 63) << 6 | (column & 63))];
      if (cell.curve() < 4)
        cell = costmap::CellCode({.dz_dx = cell.dzDx(),
                                  .dz_dy = cell.dzDy(),
                                  .curve = static_cast<std::uint8_t>(cell.curve() + 1)});
    }
  return std::make_shared<costmap::CostGrid>(content);
}

// A patch ahead of the rover, at a tenth of the way in percent, there and away again.
void replan(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  auto problem = across(map);
  FieldPlanner planner;
  const auto points = planner.plan(problem).points;
  const auto newer = patched(map, points[points.size() * static_cast<std::size_t>(state.range(1)) / 100]);
  bool changed = false;
  for (auto _ : state) {
    changed = !changed;
    problem.map = changed ? newer : map;
    benchmark::DoNotOptimize(planner.plan(problem).cost_J);
  }
}

void refinement(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  const auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0));
  const int side = map->grid().width;
  CostToGo field(edges, {{.cell = {side / 10, side / 10}}});
  field.settleAll();
  std::vector<maps::Point> route;
  for (const maps::Cell cell : field.path({side * 9 / 10, side * 19 / 20}))
    route.push_back(map->grid().centre(cell));
  const MotionCost cost(map);
  double refined_J = 0.0;
  for (auto _ : state) refined_J = cost.along(refined(cost, route));
  state.counters["grid_over_refined"] = cost.along(route) / refined_J;
}

BENCHMARK(edgeLayer)->Args({2000, 0})->Args({2000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(wholeField)->Args({2000, 0})->Args({2000, 1})->Args({4000, 0})->Unit(benchmark::kMillisecond);
BENCHMARK(refinement)->Arg(1000)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(layersToRoute)->Args({1000, 1})->Args({1000, 2})->Args({2000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(lowerBound)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(anotherStart)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(replan)->Args({2000, 2})->Args({2000, 50})->Unit(benchmark::kMillisecond);

}  // namespace
