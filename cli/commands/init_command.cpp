// talus init DEM: a mission file to start from.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/ground/mission_text.hpp>
#include <talus/common/input_error.hpp>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  MapOptions map;
  std::string output = "mission.yaml";
};

void bind(CLI::App& command, InitOptions& options) {
  addMapOptions(command, options.map);
  addOutput(command, "-o,--output", options.output, "mission to write")
      ->type_name("MISSION.yaml")
      ->capture_default_str();
  groupOptions(command, "Output");
}

// The cell with an elevation that is nearest to a share of the map's width and height.
std::string placeAt(const maps::ElevationMap& map, double share) {
  const maps::Grid& grid = map.grid();
  const maps::Cell wanted{static_cast<int>(share * grid.width), static_cast<int>(share * grid.height)};
  maps::Cell nearest = wanted;
  double least = 1e300;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const double off = std::hypot(column - wanted.column, row - wanted.row);
          off < least && !std::isnan(map.elevation_m[{column, row}])) {
        least = off;
        nearest = {column, row};
      }
  const maps::Point at = grid.centre(nearest);
  return fmt::format("{:.10g},{:.10g}", at.x_m, at.y_m);
}

int run(const InitOptions& options, Context& context) {
  std::error_code error;
  if (!context.force && fs::exists(options.output, error))
    throw InputError({options.output, "exists", "name another file with -o, or pass --force"});
  const maps::ElevationMap map = readMap(options.map, context);
  const auto [soil, rover] = assumedGround(map);
  const fs::path folder = fs::absolute(options.output, error).parent_path();
  const MissionDraft draft{.dem = fs::absolute(options.map.path, error).lexically_relative(folder).string(),
                           .resolution_m = options.map.read.resolution_m.value_or(0.0),
                           .ignore_crs = options.map.read.ignore_crs,
                           .rover = rover,
                           .soil = soil,
                           .start = placeAt(map, 0.25),
                           .goal = placeAt(map, 0.75)};
  writeFile(options.output, missionText(draft));
  if (context.json)
    printJson({{"mission", options.output}, {"start", draft.start}, {"goal", draft.goal}});
  else
    print(fmt::format("mission     {}; set start and goal, then: talus plan {}\n", options.output,
                      options.output));
  return Exit::kDone;
}

}  // namespace

void addInit(CLI::App& app, Context& context) {
  addCommand<InitOptions>(
      app, context,
      {.name = "init",
       .group = Group::kRoutes,
       .description = "write a mission file for an elevation map, every key explained",
       .examples = "  talus init gale.tif\n  talus init yard.tif --resolution 0.5 -o yard.yaml\n"},
      bind, run);
}

}  // namespace talus::cli
