#include <algorithm>
#include <cmath>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/windowed_ground.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::cli {
namespace {

constexpr double kOverviewCells = 2'000'000;
constexpr std::int64_t kPixelCache = 64 << 20;  // bytes

maps::Grid wholeGrid(const GroundOptions& options) {
  maps::ReadOptions read = options.elevation.read;
  if (!options.elevation.window.empty()) read.window = maps::parseWindow(options.elevation.window);
  return maps::elevationGrid(options.elevation.path, read);
}

}  // namespace

bool needsWindows(const GroundOptions& options, std::size_t cells) {
  if (!options.map_file.empty() || costmap::octomapType(options.elevation.path)) return false;
  return wholeGrid(options).size() > cells;
}

Ground readOverview(const GroundOptions& options, const Context& context) {
  maps::limitPixelCache(kPixelCache);
  GroundOptions coarse = options;
  const auto cells = static_cast<double>(wholeGrid(options).size());
  coarse.elevation.read.overview =
      std::max(2, static_cast<int>(std::ceil(std::sqrt(cells / kOverviewCells))));
  return readGround(coarse, context);
}

planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context) {
  const auto build = [part = options, quiet = context](
                         const planner::MapBox& box) mutable -> std::optional<costmap::TraversabilityMap> {
    quiet.quiet = true;  // warnings were printed for the overview
    part.elevation.window.clear();
    part.elevation.read.window = maps::Window{box.low, box.high};
    try {
      return readGround(part, quiet).map;
    } catch (const InputError&) {  // window without data
      return std::nullopt;
    }
  };
  return planner::WindowedMap(
      {.grid = wholeGrid(options), .overview = overview.map.published(), .build = build});
}

}  // namespace talus::cli
