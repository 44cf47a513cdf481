// talus view ROUTE|MAP: one page to look at.
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/app/sha256.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/map_options.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  MapOptions file;
  std::string map;
  std::string title;
  std::string html;
  std::string png;
};

void bind(CLI::App& command, ViewOptions& options) {
  addMapOptions(command, options.file, "FILE");
  command.get_option("FILE")->description("route from `talus plan`, traversability map, or elevation map");
  command
      .add_option(
          "--map", options.map,
          "map of a route (default: the map it was planned on, searched by its path and its name from the "
          "folder of the route and from the current folder)")
      ->type_name("MAP");
  command.add_option("--title", options.title, "title of the page")->type_name("TEXT");
  addOutput(command, "-o,--html", options.html,
            "page to write (default: FILE with the ending .html in the current folder)")
      ->type_name("PAGE.html");
  addOutput(command, "--png", options.png, "picture to write")->type_name("FILE.png");
  groupOptions(command, "Page");
}

Scene mapScene(const ViewOptions& options, const std::string& path, const Context& context) {
  const SceneOptions scene{.title =
                               options.title.empty() ? fs::path(path).filename().string() : options.title};
  if (costmap::octomapType(path) == "TraversabilityTree") return sceneOf(readBuiltMap(path, context), scene);
  MapOptions dem = options.file;
  dem.path = path;
  return sceneOf(readMap(dem, context), scene);
}

// Where the map may lie: by its path as it was given to `talus plan`, here, from the route's folder and from those above it; by
// its name beside the route and here.
std::vector<fs::path> placesOf(const planner::RouteInput& map, const fs::path& route) {
  std::error_code error;
  const fs::path folder = fs::absolute(route, error).parent_path();
  std::vector<fs::path> places{folder / map.file, fs::path(".") / map.file};
  if (map.path.empty()) return places;
  places.emplace_back(map.path);
  for (fs::path above = folder;; above = above.parent_path()) {
    places.push_back(above / map.path);
    if (above == above.parent_path()) return places;
  }
}

/// The first input of the route, where a file is the same; its name has to be that of a DEM or a traversability map, which come
/// first.
std::optional<std::string> findMap(const RouteFile& file, const std::string& route_path,
                                   const Context& context) {
  if (file.inputs.empty()) return std::nullopt;
  const planner::RouteInput& input = file.inputs.front();
  std::string other;
  for (const fs::path& path : placesOf(input, route_path)) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) continue;
    if (sha256OfFile(path.string()) == input.sha256) return path.string();
    if (other.empty()) other = path.string();
  }
  if (!other.empty())
    context.warn(other + " is not the file that the route was planned on: its checksum differs");
  context.warn("the map " + input.file + " of the route was not found; the page shows no map; pass --map");
  return std::nullopt;
}

Scene routeScene(const ViewOptions& options, const Context& context) {
  const RouteFile file = readRoute(options.file.path);
  const std::string name = fs::path(options.file.path).filename().string();
  ViewOptions titled = options;
  if (titled.title.empty()) titled.title = name;
  const std::optional<std::string> map =
      options.map.empty() ? findMap(file, options.file.path, context) : std::optional(options.map);
  if (!map) return sceneOf(file.route, {.title = titled.title});
  Scene scene = mapScene(titled, *map, context);
  if (!scene.grid().cellAt({file.route.vertices.front().x_m, file.route.vertices.front().y_m}))
    throw InputError(
        {*map, "does not contain the start of the route", "pass the map that the route was planned on"});
  addRoute(scene, file.route);
  return scene;
}

int run(const ViewOptions& options, Context& context) {
  const fs::path named(options.html);
  const fs::path html = named.empty() ? fs::path(options.file.path).stem().concat(".html") : named;
  const Scene scene = looksLikeRoute(options.file.path) ? routeScene(options, context)
                                                        : mapScene(options, options.file.path, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  if (!options.png.empty()) savePicture(options.png, scene);
  savePage(html, scene);
  if (context.json)
    printJson({{"html", html.string()}, {"facts", nlohmann::ordered_json(scene.facts)}});
  else
    print(fmt::format("page        {}\n", html.string()));
  return Exit::kDone;
}

}  // namespace

void addView(CLI::App& app, Context& context) {
  addCommand<ViewOptions>(app, context,
                          {.name = "view",
                           .group = Group::kRoutes,
                           .description = "write a self-contained HTML page: map layers, route and profiles",
                           .examples = "  talus view route.geojson\n"
                                       "  talus view gale.ot -o gale.html --png gale.png\n"},
                          bind, run);
}

}  // namespace talus::cli
