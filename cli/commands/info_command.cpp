// talus info DEM: properties of a map, for checks before planning.

#include <talus/cli/app/command.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::cli {
namespace {

struct InfoOptions {
  ElevationFile map;
  double footprint_m = 0.0;
};

nlohmann::ordered_json infoJson(const maps::ElevationMap& map, const maps::TerrainMetrics& metrics) {
  const maps::Grid& grid = map.grid();
  const std::vector<double> slope = quantiles(slope_deg(metrics), {0.5, 0.9, 0.99});
  const std::vector<double> height = quantiles(map.elevation_m, {0.0, 1.0});
  nlohmann::ordered_json out;
  out["width"] = grid.width;
  out["height"] = grid.height;
  out["resolution_m"] = grid.resolution_m;
  out["crs"] = map.georeference ? map.georeference->system().name : "local";
  out["body"] =
      map.georeference ? nlohmann::ordered_json(map.georeference->body()) : nlohmann::ordered_json();
  out["valid_fraction"] = maps::validFraction(map.elevation_m);
  out["slope_deg"] = {{"p50", slope[0]}, {"p90", slope[1]}, {"p99", slope[2]}};
  out["elevation_m"] = {{"min", height[0]}, {"max", height[1]}};
  out["x_m"] = {grid.south_west.x_m, grid.south_west.x_m + grid.width * grid.resolution_m};
  out["y_m"] = {grid.south_west.y_m, grid.south_west.y_m + grid.height * grid.resolution_m};
  out["footprint_cells"] = metrics.footprint_cells;
  out["reading"] = map.reading;
  out["files"] = planner::originJson({.files = filesRead()})["files"];
  return out;
}

std::string latitudes(const maps::ElevationMap& map) {
  if (!map.georeference) return "";
  const maps::Grid& grid = map.grid();
  const maps::Point middle{grid.south_west.x_m + 0.5 * grid.width * grid.resolution_m,
                           grid.south_west.y_m + 0.5 * grid.height * grid.resolution_m};
  return fmt::format("centre      {}\n", maps::describe(middle, map));
}

std::string infoText(const maps::ElevationMap& map, const nlohmann::ordered_json& facts) {
  const maps::Grid& grid = map.grid();
  const auto number = [&](const char* object, const char* key) { return facts[object][key].get<double>(); };
  return fmt::format("map         {}\n", map.source) +
         fmt::format("cells       {} x {} of {:.6g} m ({:.4g} x {:.4g} km)\n", grid.width, grid.height,
                     grid.resolution_m, grid.width * grid.resolution_m / 1000,
                     grid.height * grid.resolution_m / 1000) +
         (map.reading.empty() ? "" : fmt::format("read        {}\n", map.reading)) +
         fmt::format("CRS         {}{}\n", facts["crs"].get<std::string>(),
                     map.georeference ? " (" + map.georeference->body() + ")" : " metres") +
         fmt::format("extent      {}\n", maps::extent(grid)) + latitudes(map) +
         fmt::format("valid       {:.1f} % of cells\n", 100 * facts["valid_fraction"].get<double>()) +
         fmt::format("elevation   {:.1f} to {:.1f} m\n", number("elevation_m", "min"),
                     number("elevation_m", "max")) +
         fmt::format(
             "slope       median {:.1f} deg, 90th percentile {:.1f} deg, 99th percentile {:.1f} deg\n",
             number("slope_deg", "p50"), number("slope_deg", "p90"), number("slope_deg", "p99"));
}

void bind(CLI::App& command, InfoOptions& options) {
  addMapOptions(command, options.map);
  addOption(command, "--footprint METRES", options.footprint_m);
}

int run(const InfoOptions& options, Context& context) {
  const maps::ElevationMap map = readMap(options.map, readingOf(context));
  const maps::TerrainMetrics metrics =
      maps::terrainMetrics(map.elevation_m, {.radius_m = options.footprint_m, .threads = context.workers()},
                           context.watch("slopes"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const nlohmann::ordered_json facts = infoJson(map, metrics);
  context.answer(facts, infoText(map, facts));
  return Exit::kDone;
}

}  // namespace

void addInfo(CLI::App& app, Context& context) {
  addCommand<InfoOptions>(app, context, "info", bind, run);
}

}  // namespace talus::cli
