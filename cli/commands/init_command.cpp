// talus init DEM: writes a mission file as a starting point.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  ElevationFile map;
  std::string output = "mission.yaml";
};

void bind(CLI::App& command, InitOptions& options) {
  addMapOptions(command, options.map);
  addOutput(command, "-o,--output MISSION.yaml", options.output);
}

// Largest set of cells that are connected by drives between cell centres in both directions; empty if no cell
// is permitted.
std::vector<maps::Cell> largestPart(const costmap::TraversabilityMap& map) {
  const planner::MotionCost cost(map.published());
  const maps::Grid& grid = map.grid();
  const auto joined = [&](maps::Cell a, maps::Cell b) {
    const maps::Point from = grid.centre(a), to = grid.centre(b);
    return std::isfinite(cost({from, to})) && std::isfinite(cost({to, from}));
  };
  maps::Raster<std::uint8_t> seen(grid);
  std::vector<maps::Cell> largest, part;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      if (seen[{column, row}] != 0 || !cost.allowed(grid.centre({column, row}))) continue;
      part.assign(1, {column, row});
      seen[{column, row}] = 1;
      for (std::size_t next = 0; next < part.size(); ++next) {
        const maps::Cell at = part[next];
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
          const maps::Cell beside{at.column + dx, at.row + dy};
          if (!grid.contains(beside) || seen[beside] != 0 || !joined(at, beside)) continue;
          seen[beside] = 1;
          part.push_back(beside);
        }
      }
      if (part.size() > largest.size()) largest.swap(part);
    }
  return largest;
}

// The cell nearest to a given share of the map's width and height.
std::string placeAt(const std::vector<maps::Cell>& cells, const maps::Grid& grid, double share) {
  const auto off = [&](maps::Cell cell) {
    return std::hypot(cell.column - std::floor(share * grid.width),
                      cell.row - std::floor(share * grid.height));
  };
  const maps::Point at = grid.centre(*std::ranges::min_element(cells, {}, off));
  return fmt::format("{:.10g},{:.10g}", at.x_m, at.y_m);
}

// Takes the layers that `talus generate` and others write to the folder of an elevation map, by their names.
// Classes and their soils are taken only together.
void takeLayersBeside(const fs::path& dem, GroundOptions& ground, const Context& context) {
  const auto found = [&](const char* suffix, const char* extension) {
    const fs::path path = dem.parent_path() / (dem.stem().string() + suffix + extension);
    std::error_code error;
    return fs::is_regular_file(path, error) ? path.string() : std::string();
  };
  ground.rocks = found("_rocks", ".tif");
  const std::string classes = found("_classes", ".tif"), soils = found("_soils", ".yaml");
  if (classes.empty() != soils.empty())
    return context.warn(fmt::format("{} is not taken: {} is missing beside it", classes + soils,
                                    dem.stem().string() + (soils.empty() ? "_soils.yaml" : "_classes.tif")));
  ground.classes = classes;
  ground.soils = soils;
  if (!soils.empty()) ground.soil.clear();
}

int run(const InitOptions& options, Context& context) {
  std::error_code error;
  if (!context.force && fs::exists(options.output, error))
    throw InputError({options.output, "exists", "name another file with -o, or pass --force"});
  const maps::ElevationMap map = readMap(options.map, readingOf(context));
  const auto [soil, rover] = assumedGround(map);
  GroundOptions choices{{.elevation = options.map, .soil = soil, .rover = rover}};
  takeLayersBeside(options.map.path, choices, context);
  const Ground ground = readGround(choices, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  std::vector<maps::Cell> cells = largestPart(ground.map);
  if (cells.empty()) {
    context.warn(
        fmt::format("rover {} on {} may drive nowhere on this map: choose rover and soil", rover, soil));
    cells = {{map.grid().width / 4, map.grid().height / 4},
             {3 * map.grid().width / 4, 3 * map.grid().height / 4}};
  }
  const fs::path folder = fs::weakly_canonical(fs::absolute(options.output), error).parent_path();
  const auto relative = [&](const std::string& path) {
    return path.empty() ? path : fs::weakly_canonical(path, error).lexically_relative(folder).string();
  };
  std::map<std::string, nlohmann::json> mission{
      {"dem", relative(options.map.path)},
      {"terrain", relative(choices.classes)},
      {"rocks", relative(choices.rocks)},
      {"rover", rover},
      {"soil", choices.soil},
      {"soils", relative(choices.soils)},
      {"start", placeAt(cells, map.grid(), 0.25)},
      {"goal", placeAt(cells, map.grid(), 0.75)},
      {"output", fs::path(options.output).stem().string() + "_route.geojson"}};
  if (options.map.read.resolution_m) mission["resolution_m"] = *options.map.read.resolution_m;
  if (options.map.read.ignore_crs) mission["ignore_crs"] = true;
  writeFile(options.output, missionText(mission));
  std::vector<std::string> layers{mission["terrain"], mission["soils"], mission["rocks"]};
  std::erase(layers, "");
  context.answer({{"mission", options.output},
                  {"start", mission["start"]},
                  {"goal", mission["goal"]},
                  {"layers", layers}},
                 fmt::format("{}mission     {}; set start and goal, then: talus plan {}\n",
                             layers.empty() ? "" : fmt::format("layers      {}\n", fmt::join(layers, ", ")),
                             options.output, options.output));
  return Exit::kDone;
}

}  // namespace

void addInit(CLI::App& app, Context& context) {
  addCommand<InitOptions>(app, context, "init", bind, run);
}

}  // namespace talus::cli
