// Slope, roughness and step of 4 M cells, from the file to the layers, beside GDAL on the same file in the
// same run.
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>

#include <benchmark/benchmark.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/sites/site_generator.hpp>
#include <talus/maps/terrain/plane_fit.hpp>

namespace {

using namespace talus::maps;

constexpr int kSide = 2000;

int cores() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

const ElevationMap& site() {
  static const ElevationMap map = generateSite({.width = kSide, .height = kSide, .threads = cores()}).map;
  return map;
}

// The elevation file, compressed as Talus writes it, or uncompressed.
std::string file(bool compressed) {
  const std::string path =
      (std::filesystem::temp_directory_path() / (compressed ? "talus_4m.tif" : "talus_4m_plain.tif"))
          .string();
  if (std::filesystem::exists(path)) return path;
  writeGeoTiff({(std::filesystem::temp_directory_path() / "talus_4m.tif").string(), &*site().georeference},
               {{"elevation", "m", site().elevation_m}});
  if (compressed) return path;
  const std::string source = file(true);
  GDALDatasetH input = GDALOpen(source.c_str(), GA_ReadOnly);
  GDALTranslateOptions* options = GDALTranslateOptionsNew(nullptr, nullptr);
  GDALClose(GDALTranslate(path.c_str(), input, options, nullptr));
  GDALTranslateOptionsFree(options);
  GDALClose(input);
  return path;
}

void countCells(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * std::int64_t{kSide} * kSide);
}

// Arguments: footprint radius in cells, threads.
void metrics(benchmark::State& state) {
  site();  // made before the timing starts
  const FootprintOptions options{.radius_m = static_cast<double>(state.range(0)),
                                 .threads = static_cast<int>(state.range(1))};
  for (auto _ : state) benchmark::DoNotOptimize(terrainMetrics(site().elevation_m, options));
  countCells(state);
}
BENCHMARK(metrics)->ArgsProduct({{0, 2, 5, 10}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

void readAndMeasure(benchmark::State& state) {
  const std::string path = file(state.range(0) != 0);
  for (auto _ : state) {
    const ElevationMap map = readElevation(path);
    benchmark::DoNotOptimize(terrainMetrics(map.elevation_m, {.threads = cores()}));
  }
  countCells(state);
}
BENCHMARK(readAndMeasure)
    ->ArgName("compressed")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void readAlone(benchmark::State& state) {
  const std::string path = file(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(readElevation(path));
  countCells(state);
}
BENCHMARK(readAlone)->ArgName("compressed")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

// The equivalent in gdaldem: slope, terrain ruggedness and roughness, each to an uncompressed file in
// memory.
void gdaldem(benchmark::State& state) {
  const std::string path = file(state.range(0) != 0);
  for (auto _ : state)
    for (const char* mode : {"slope", "TRI", "roughness"}) {
      GDALDatasetH input = GDALOpen(path.c_str(), GA_ReadOnly);
      GDALDatasetH output = GDALDEMProcessing("/vsimem/out.tif", input, mode, nullptr, nullptr, nullptr);
      GDALClose(output);
      GDALClose(input);
    }
  countCells(state);
}
BENCHMARK(gdaldem)->ArgName("compressed")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
