// Cost of a map's updates for several map sizes: one sample until publication, a patch of changed cells, and
// memory.
#include <cmath>
#include <fstream>
#include <memory>
#include <random>
#include <string>

#include <benchmark/benchmark.h>
#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>

namespace {

using namespace talus;
using costmap::TraversabilityMap;

std::unique_ptr<TraversabilityMap> mapOf(int side) {
  costmap::MapLayers layers;
  layers.elevation.elevation_m =
      maps::Raster<float>({.width = side, .height = side, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(2.0 * std::sin(0.05 * column) * std::cos(0.04 * row));
  return std::make_unique<TraversabilityMap>(std::move(layers), costmap::testGround(),
                                             TraversabilityMap::Options{});
}

costmap::WheelObservation seen(const maps::Point& place, double pull) {
  return {.time_s = 1.0,
          .place = place,
          .pull = {pull, 0.05},
          .sinkage = {0.17, 0.05},
          .trust = costmap::Trust::Once};
}

// Samples of six wheels at 100 Hz along a line, each learned and published separately.
void sample(benchmark::State& state) {
  const auto map = mapOf(static_cast<int>(state.range(0)));
  std::mt19937_64 random(1);
  std::normal_distribution<double> pull(0.2, 0.05);
  double along_m = 100.0;
  for (auto _ : state) {
    map->learn(seen({along_m, 300.3 + 0.3 * std::sin(37.0 * along_m)}, pull(random)));
    map->publish();
    along_m += 0.1 / 600.0;  // 0.1 m/s
  }
}
BENCHMARK(sample)->Arg(1000)->Arg(2000)->Arg(4000)->Unit(benchmark::kMicrosecond);

// The worst case, in which every sample lies on ground without evidence.
void sampleOnNewGround(benchmark::State& state) {
  const auto map = mapOf(static_cast<int>(state.range(0)));
  std::mt19937_64 random(1);
  std::normal_distribution<double> pull(0.2, 0.05);
  double x = 20.0, y = 20.0;
  for (auto _ : state) {
    map->learn(seen({x, y}, pull(random)));
    map->publish();
    x += 1.3;
    if (x > static_cast<double>(state.range(0)) - 20.0) x = 20.0, y += 7.0;
  }
}
BENCHMARK(sampleOnNewGround)->Arg(1000)->Arg(4000)->Iterations(3000)->Unit(benchmark::kMicrosecond);

// Time from a change of 200x200 cells to a new plan.
void patch(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  auto map = mapOf(side);
  const auto refused = costmap::CellCode({.curve = costmap::CellCode::kBlocked});
  auto grid = map->published();
  bool on = false;
  for (auto _ : state) {
    on = !on;
    const maps::CellBox range{{side / 2, side / 2}, {side / 2 + 199, side / 2 + 199}};
    grid = std::make_shared<costmap::CostGrid>(revised(
        *grid, {.ranges = {range},
                .code = [&](maps::Cell, costmap::CellCode code) { return on ? refused : code.withCurve(0); },
                .cost = [&] { return grid->content().cost; }}));
    benchmark::DoNotOptimize(grid);
  }
}
BENCHMARK(patch)->Arg(1000)->Arg(2000)->Arg(4000)->Unit(benchmark::kMicrosecond);

double residentMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmRSS:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kilobytes / 1024.0;
    }
  return 0.0;
}

// Memory of a map of 16 M cells without evidence, and with a sample in every block of ground.
void memory(benchmark::State& state) {
  for (auto _ : state) {
    const double before = residentMegabytes();
    const auto map = mapOf(4000);
    state.counters["MB_without"] = residentMegabytes() - before;
    const int block = map->evidence().blockCells();
    for (int row = 0; row < 4000; row += block)
      for (int column = 0; column < 4000; column += block) map->learn(seen({column + 0.5, row + 0.5}, 0.2));
    state.counters["MB_learned"] = residentMegabytes() - before;
    map->publish();
    state.counters["MB_with"] = residentMegabytes() - before;
  }
}
BENCHMARK(memory)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
