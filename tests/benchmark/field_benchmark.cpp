// The steps of the field planner on undulating ground with blocked cells. Only ratios within one run are
// comparable.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <stop_token>
#include <thread>

#include <benchmark/benchmark.h>
#include <pthread.h>
#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/refine/any_angle.hpp>

namespace {

using namespace talus;
using namespace talus::planner;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

std::shared_ptr<const costmap::TravelCost> driveCost() {
  std::vector<costmap::TravelCurve> curves;
  for (int k = 0; k < 5; ++k) {
    std::vector<float> costs;
    for (int row = 0; row <= 20; ++row)
      for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin) {
        const double g = costmap::TravelCurve::gradient(bin);
        const auto level = static_cast<float>((1.0 + k) * (10.0 + 100.0 * std::fmax(g, 0.0) + 400.0 * g * g));
        // Crossing a slope costs 2 % more for each row of 1/64.
        costs.push_back(level * static_cast<float>(1.0 + 0.02 * row));
      }
    curves.emplace_back(std::move(costs));
  }
  return std::make_shared<costmap::TravelCost>(
      costmap::TravelCost::Limits{.max_along = 0.3, .max_across = 0.3}, curves);
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

// The map with one soil changed in 200x200 cells around a point.
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

// A patch ahead of the rover, at a tenth of the route in percent, applied and removed in turn.
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

double cpu_ms(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// New heights in a window of 200 x 200 cells at a share of the route in percent: time from the patch to the
// route, on a map of two soils without evidence. `patch_ms`: the map's share of the time. Every second
// window restores heights for which the planner's field is still valid; `there_ms`: the mean of the other
// windows, the cost of new ground.
void heightsToRoute(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const maps::Grid grid{.width = side, .height = side, .resolution_m = 1.0, .south_west = {}};
  const auto height = [](double x, double y, double wave) {
    return static_cast<float>(3.0 * std::sin(0.02 * x) * std::cos(0.015 * y) + wave * std::sin(0.5 * x));
  };
  costmap::MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      layers.elevation.elevation_m[{column, row}] = height(column, row, 0.0);
  costmap::TraversabilityMap map(std::move(layers), costmap::testGround(), {});
  auto problem = across(map.published());
  FieldPlanner planner;
  const auto points = planner.plan(problem).points;
  const maps::Point at = points[points.size() * static_cast<std::size_t>(state.range(1)) / 100];
  const double column0 = std::clamp(std::floor(at.x_m) - 100.0, 0.0, side - 200.0),
               row0 = std::clamp(std::floor(at.y_m) - 100.0, 0.0, side - 200.0);
  std::array<costmap::SurfacePatch, 2> windows;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    windows[k].elevation_m = maps::Raster<float>(
        {.width = 200, .height = 200, .resolution_m = 1.0, .south_west = {column0, row0}});
    for (int row = 0; row < 200; ++row)
      for (int column = 0; column < 200; ++column)
        windows[k].elevation_m[{column, row}] =
            height(column0 + column, row0 + row, 0.1 * static_cast<double>(k));
  }
  std::size_t turn = 0;
  double patching_ms = 0.0, there_ms = 0.0, there = 0.0;
  for (auto _ : state) {
    const double before_ms = cpu_ms(CLOCK_THREAD_CPUTIME_ID);
    map.patch(windows[++turn % 2]);
    patching_ms += cpu_ms(CLOCK_THREAD_CPUTIME_ID) - before_ms;
    problem.map = map.published();
    benchmark::DoNotOptimize(planner.plan(problem).cost_J);
    if (turn % 2 == 0) continue;
    there_ms += cpu_ms(CLOCK_THREAD_CPUTIME_ID) - before_ms;
    there += 1.0;
  }
  state.counters["there_ms"] = there_ms / there;
  state.counters["patch_ms"] = patching_ms / static_cast<double>(state.iterations());
}

// A path of a thousand points, checked against the map at a quantile of the estimate.
void monitor(benchmark::State& state) {
  costmap::MapLayers layers;
  layers.elevation.elevation_m =
      maps::Raster<float>({.width = 1000, .height = 1000, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < 1000; ++row)
    for (int column = 0; column < 1000; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(3.0 * std::sin(0.02 * column) * std::cos(0.015 * row));
  const auto map = costmap::TraversabilityMap(std::move(layers), costmap::testGround(), {}).published();
  std::vector<maps::Point> path;
  for (int k = 0; k < 1000; ++k) path.push_back({20.0 + 0.9 * k, 500.0 + 200.0 * std::sin(0.01 * k)});
  std::size_t found = 0;
  for (auto _ : state) found = dangers(*map, path).size();
  state.counters["dangers"] = static_cast<double>(found);
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
  for (auto _ : state) refined_J = cost.along(Refiner()(cost, route));
  state.counters["grid_over_refined"] = cost.along(route) / refined_J;
}

// Routes between corners and sides, refined with the default options and with a search twice as fine and
// three times as wide.
void againstFinest(benchmark::State& state) {
  const auto map = rollingGround(static_cast<int>(state.range(0)));
  const MotionCost cost(map);
  RefineOptions finest;
  finest.reach_cells = 12;
  finest.points_per_side = 6;
  finest.slides = 20;
  std::vector<double> gaps;
  for (auto _ : state)
    for (int k = 0; k < 12; ++k) {
      const double side = map->grid().width, angle = 0.5236 * k;
      const auto goals = fieldGoals(cost, {0.5 * side, 0.5 * side}, 3.0);
      CostToGo field(std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0)), goals);
      const Segment ends{{side * (0.5 + 0.45 * std::cos(angle)), side * (0.5 + 0.45 * std::sin(angle))},
                         {0.5 * side, 0.5 * side}};
      const auto route = gridRoute(cost, field, ends);
      if (route.empty()) continue;
      const double plain_J = cost.along(Refiner()(cost, route)),
                   finest_J = cost.along(Refiner(finest)(cost, route));
      gaps.push_back(100.0 * (plain_J / std::min(plain_J, finest_J) - 1.0));
    }
  std::sort(gaps.begin(), gaps.end());
  state.counters["routes"] = static_cast<double>(gaps.size());
  state.counters["median_percent"] = gaps[gaps.size() / 2];
  state.counters["worst_percent"] = gaps.back();
}

// A plan with its proof, cancelled at forty moments: the longest CPU time that its thread continues after
// the request.
void cancelling(benchmark::State& state) {
  auto problem = across(rollingGround(static_cast<int>(state.range(0))));
  problem.prove = true;
  constexpr double kAsking_ms = 0.1;
  double worst_ms = 0.0;
  int samples = 0;
  for (auto _ : state) {
    const double begin_ms = cpu_ms(CLOCK_THREAD_CPUTIME_ID);
    FieldPlanner().plan(problem);
    const double whole_ms = cpu_ms(CLOCK_THREAD_CPUTIME_ID) - begin_ms;
    for (int k = 0; k < 40; ++k) {
      std::stop_source source;
      problem.watch.stop = source.get_token();
      double end_ms = 0.0;
      std::jthread worker([&] {
        FieldPlanner().plan(problem);
        end_ms = cpu_ms(CLOCK_THREAD_CPUTIME_ID);
      });
      clockid_t its_time{};
      if (pthread_getcpuclockid(worker.native_handle(), &its_time) != 0) continue;
      const double stop_at_ms = whole_ms * (k + 0.5) / 40;
      double asked_ms = cpu_ms(its_time);
      while (asked_ms < stop_at_ms) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        const double now_ms = cpu_ms(its_time);
        if (!(now_ms > 0.0)) break;
        asked_ms = now_ms;
      }
      asked_ms = cpu_ms(its_time);
      source.request_stop();
      const double heard_ms = cpu_ms(its_time);
      worker.join();
      // A sample counts only if this thread did not wait while it made the request, because the time of the
      // request is otherwise unknown; the clock of a thread that has ended returns nothing.
      if (asked_ms > 0.0 && heard_ms - asked_ms < kAsking_ms)
        worst_ms = std::max(worst_ms, end_ms - asked_ms), ++samples;
    }
    problem.watch = {};
  }
  state.counters["worst_cpu_ms"] = worst_ms;
  state.counters["samples"] = samples;
}

BENCHMARK(edgeLayer)->Args({2000, 0})->Args({2000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(wholeField)->Args({2000, 0})->Args({2000, 1})->Args({4000, 0})->Unit(benchmark::kMillisecond);
BENCHMARK(refinement)->Arg(1000)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(layersToRoute)->Args({1000, 1})->Args({1000, 2})->Args({2000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(lowerBound)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(anotherStart)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(againstFinest)->Arg(1000)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(cancelling)->Arg(1000)->Arg(2000)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(monitor)->Unit(benchmark::kMillisecond);
BENCHMARK(heightsToRoute)->Args({2000, 2})->Args({2000, 50})->Unit(benchmark::kMillisecond);
BENCHMARK(replan)->Args({2000, 2})->Args({2000, 50})->Unit(benchmark::kMillisecond);

}  // namespace
