// talus view ROUTE|MAP [ROUTE ...]: writes an HTML page or a picture.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <talus/cli/app/command.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  ElevationFile file;
  std::vector<std::string> others;  ///< routes compared with the first
  std::string map;
  std::string title;
  std::string html;
  std::string png;
  std::string image;
};

void bind(CLI::App& command, ViewOptions& options) {
  addMapOptions(command, options.file, "FILE");
  addOption(command, "ROUTE ROUTE ...", options.others);
  addOption(command, "--map MAP", options.map);
  addOption(command, "--title TEXT", options.title);
  addOutput(command, "-o,--html PAGE.html", options.html);
  addOutput(command, "--png FILE.png", options.png);
  addOption(command, "--image ORTHO.tif", options.image)->check(CLI::ExistingFile);
}

// The map of a mission, with its start and goals.
Scene missionScene(const std::string& path, const SceneOptions& options, const Context& context) {
  PlanOptions plan;
  plan.ground.elevation.path = path;
  readMission(plan);
  const Ground ground = readGround(plan.ground, context);
  Scene scene = sceneOf(ground.map, options);
  const auto mark = [&](const char* letter, const std::string& place) {
    if (!place.empty())
      scene.marks.emplace_back(letter, maps::readPlace(place, ground.map.elevation(), path));
  };
  mark("S", plan.start);
  for (const std::string& goal : plan.goals) mark("G", goal);
  return scene;
}

Scene mapScene(const ViewOptions& options, const std::string& path, const Context& context) {
  const SceneOptions scene{.title =
                               options.title.empty() ? fs::path(path).filename().string() : options.title};
  if (isMission(path)) return missionScene(path, scene, context);
  if (costmap::octomapType(path) == "TraversabilityTree")
    return sceneOf(readBuiltMap(path, readingOf(context)), scene);
  ElevationFile dem = options.file;
  dem.path = path;
  return sceneOf(readMap(dem, readingOf(context)), scene);
}

// Candidate paths of the map. By file name: the folder of the route and the current folder. By the path given
// to `talus plan`: the current folder, the folder of the route and all its parents.
std::vector<fs::path> placesOf(const InputFile& map, const fs::path& route) {
  std::error_code error;
  const fs::path folder = fs::absolute(route, error).parent_path();
  const fs::path name = fs::path(map.path).filename();
  std::vector<fs::path> places{folder / name, fs::path(".") / name, map.path};
  for (fs::path above = folder;; above = above.parent_path()) {
    places.push_back(above / map.path);
    if (above == above.parent_path()) return places;
  }
}

/// Path of a file whose SHA-256 equals that of an input of the route; otherwise nothing, and in `other` a file of
/// the same name, if any.
std::optional<std::string> findInput(const InputFile& input, const std::string& route_path,
                                     std::string& other) {
  for (const fs::path& path : placesOf(input, route_path)) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) continue;
    if (sha256OfFile(path.string()) == input.sha256) return path.string();
    if (other.empty()) other = path.string();
  }
  return std::nullopt;
}

/// Path of the DEM or traversability map of the route; nothing, with a warning, if no such file is found.
std::optional<std::string> findMap(const RouteFile& file, const std::string& route_path,
                                   const Context& context) {
  if (file.inputs.empty()) return std::nullopt;
  std::string other;
  if (auto found = findInput(file.inputs.front(), route_path, other)) return found;
  if (!other.empty())
    context.warn(other + " is not the file that the route was planned on: its checksum differs");
  context.warn("the map " + fs::path(file.inputs.front().path).filename().string() +
               " of the route was not found; the page shows no map; pass --map");
  return std::nullopt;
}

/// Traversability map of the mission of the route; nothing if the route has none, or if one of its files is not found.
std::optional<costmap::TraversabilityMap> missionMap(const RouteFile& file, const std::string& route_path,
                                                     const Context& context) {
  PlanOptions plan;
  for (const InputFile& input : file.inputs) {
    std::string other;
    const auto found = findInput(input, route_path, other);
    if (!found) return std::nullopt;
    if (input.role == "mission") plan.ground.elevation.path = *found;
  }
  if (plan.ground.elevation.path.empty()) return std::nullopt;
  readMission(plan);
  return readGround(plan.ground, context).map;
}

void requireInside(const Scene& scene, const planner::Route& route, const std::string& map,
                   const std::string& path) {
  if (scene.grid().cellAt({route.vertices.front().x_m, route.vertices.front().y_m})) return;
  throw InputError(
      {map, "does not contain the start of the route " + path, "pass the map that the route was planned on"});
}

std::string nameOf(const std::string& path) {
  return fs::path(path).filename().string();
}

void compareWithOthers(Scene& scene, const ViewOptions& options, const RouteFile& first,
                       const std::string& map) {
  std::vector<NamedRoute> routes{{nameOf(options.file.path), first.route, first.provenance}};
  for (const std::string& path : options.others) {
    const RouteFile other = readRoute(path);
    if (!map.empty()) requireInside(scene, other.route, map, path);
    const std::string name = nameOf(path);
    const bool taken =
        std::any_of(routes.begin(), routes.end(), [&](const NamedRoute& r) { return r.name == name; });
    routes.push_back({taken ? path : name, other.route, other.provenance});
  }
  compare(scene, std::move(routes));
}

Scene routeScene(const ViewOptions& options, const Context& context) {
  const RouteFile file = readRoute(options.file.path);
  ViewOptions titled = options;
  if (titled.title.empty()) {
    titled.title = nameOf(options.file.path);
    for (const std::string& other : options.others) titled.title += " and " + nameOf(other);
  }
  const std::optional<std::string> map =
      options.map.empty() ? findMap(file, options.file.path, context) : std::optional(options.map);
  const auto built = options.map.empty() && map ? missionMap(file, options.file.path, context) : std::nullopt;
  Scene scene = built ? sceneOf(*built, {.title = titled.title})
                : map ? mapScene(titled, *map, context)
                      : sceneOf(file.route, {.title = titled.title});
  if (map) requireInside(scene, file.route, *map, options.file.path);
  if (map || !options.others.empty()) scene.facts.clear();  // rover and soil are in the provenance, too
  if (!options.others.empty()) {
    compareWithOthers(scene, options, file, map.value_or(""));
  } else {
    if (map) addRoute(scene, file.route);
    scene.provenance = file.provenance;
  }
  return scene;
}

std::string comparisonText(const Scene& scene) {
  std::string text;
  for (const ComparedFact& fact : scene.comparison)
    text += summaryLine(fact.name, fmt::format("{}", fmt::join(fact.values, " | ")));
  return text;
}

int run(const ViewOptions& options, Context& context) {
  const fs::path named(options.html);
  const fs::path html = named.empty() ? fs::path(options.file.path).stem().concat(".html") : named;
  const bool of_route = looksLikeRoute(options.file.path);
  maps::requireReadableFile(options.file.path);
  if (!of_route && !options.others.empty())
    throw InputError({options.file.path, "is not a route file; only routes can be compared",
                      "pass routes, and the map as --map"});
  const ProgressMonitor drawing = context.watch("draw");
  Scene scene = of_route ? routeScene(options, context) : mapScene(options, options.file.path, context);
  if (!of_route) addGroundFacts(scene);
  scene.image = groundPicture(options.image, scene.georeference, scene.grid());
  if (context.stop.stop_requested()) return Exit::kCancelled;
  saveScene(scene, html, options.png);
  nlohmann::ordered_json json{{"html", html.string()}, {"facts", nlohmann::ordered_json(scene.facts)}};
  for (const ComparedFact& fact : scene.comparison) json["comparison"][fact.name] = fact.values;
  context.answer(json, comparisonText(scene) + fmt::format("page        {}\n", html.string()));
  return Exit::kDone;
}

}  // namespace

void addView(CLI::App& app, Context& context) {
  addCommand<ViewOptions>(app, context, "view", bind, run);
}

}  // namespace talus::cli
