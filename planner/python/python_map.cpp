#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>

#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/spatial_reference.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/python_map.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

// Exclusive access to a session for one call; does not wait, because the GIL is held.
std::unique_lock<std::mutex> held(Session& session) {
  std::unique_lock lock(session.work, std::try_to_lock);
  if (!lock.owns_lock())
    throw std::runtime_error("another thread works on this map; wait for it, or give each thread its own");
  return lock;
}

costmap::GroundClass classOf(int number, const py::handle& soil, const terramech::Rover& rover) {
  if (number < 0 || number > 254)
    throw py::value_error("soils: class " + std::to_string(number) + ", must be 0 to 254");
  if (py::isinstance<py::str>(soil))
    return costmap::groundClass(number, terramech::loadSoilPrior(soil.cast<std::string>()), rover);
  if (py::isinstance<terramech::Soil>(soil)) return {.number = number, .soil = soil.cast<terramech::Soil>()};
  throw py::type_error("soils: a soil must be a name or a talus.Soil");
}

std::vector<costmap::GroundClass> classesOf(const py::object& soils, const terramech::Rover& rover) {
  if (!py::isinstance<py::dict>(soils)) return {classOf(0, soils, rover)};
  std::vector<costmap::GroundClass> classes;
  for (const auto& [number, soil] : soils.cast<py::dict>()) {
    if (!py::isinstance<py::int_>(number)) throw py::type_error("soils: the keys must be class numbers");
    classes.push_back(classOf(number.cast<int>(), soil, rover));
  }
  return classes;
}

std::vector<costmap::CostLayer> costsOf(const py::dict& given, const maps::Grid& grid) {
  std::vector<costmap::CostLayer> layers;
  for (const auto& [name, values] : given) {
    if (!py::isinstance<py::str>(name)) throw py::type_error("layers: the keys must be names");
    costmap::CostLayer layer{.name = name.cast<std::string>()};
    layer.added_J_per_m =
        floatsOf(py::reinterpret_borrow<py::object>(values), "layers['" + layer.name + "']", grid, false);
    for (const float v : layer.added_J_per_m.values())
      if (std::isfinite(v)) layer.unseen_J_per_m = std::max(layer.unseen_J_per_m, v);
    layers.push_back(std::move(layer));
  }
  return layers;
}

void requireThreads(int threads) {
  if (threads < 1) throw py::value_error("threads = " + std::to_string(threads) + ", must be >= 1");
}

std::optional<maps::Georeference> georeferenceOf(const std::string& crs, const maps::Grid& grid) {
  if (crs.empty()) return std::nullopt;
  const maps::GdalErrors errors;
  OGRSpatialReference system;
  if (system.SetFromUserInput(crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS) !=
      OGRERR_NONE)
    throw InputError({"crs '" + crs + "'", "is not known", "give an EPSG code (EPSG:32633) or WKT"});
  return maps::georeferenceOn(maps::coordinateSystem(system, "crs '" + crs + "'"), grid);
}

Map built(const PythonMap::Layers& layers, const PythonMap::Ground& ground) {
  const maps::Grid grid = gridOf(layers.heights, "heights",
                                 {.resolution_m = ground.resolution_m, .south_west = ground.south_west});
  requireThreads(ground.threads);
  costmap::MapLayers made;
  made.elevation = {.elevation_m = floatsOf(layers.heights, "heights", grid),
                    .georeference = georeferenceOf(ground.crs, grid),
                    .source = "heights"};
  made.classes = bytesOf(layers.classes, "classes", grid);
  if (made.classes.empty() && py::isinstance<py::dict>(ground.soils) &&
      ground.soils.cast<py::dict>().size() > 1)
    throw py::value_error("classes: needed where soils has more than one class");
  made.rock_abundance = floatsOf(layers.rocks, "rocks", grid);
  made.keep_out = bytesOf(layers.keep_out, "keep_out", grid);
  made.costs = costsOf(layers.costs, grid);
  costmap::GroundModel::Parts parts{
      .rover = ground.rover, .classes = classesOf(ground.soils, ground.rover), .policy = ground.policy};
  const py::gil_scoped_release released;
  return Map({.layers = std::move(made),
              .ground = costmap::GroundModel(std::move(parts)),
              .options = {.threads = ground.threads}});
}

}  // namespace

PythonMap::PythonMap(const Layers& layers, const Ground& ground) : PythonMap(built(layers, ground)) {}

void PythonMap::patch(const Layers& layers, maps::Point south_west) {
  const auto lock = held(*session_);
  const py::object* first = nullptr;
  for (const py::object* each : {&layers.heights, &layers.classes, &layers.rocks, &layers.keep_out})
    if (!each->is_none() && first == nullptr) first = each;
  if (first == nullptr) throw py::value_error("patch: give heights, classes, rocks or keep_out");
  const maps::Grid grid =
      gridOf(*first, "patch", {.resolution_m = map().grid().resolution_m, .south_west = south_west});
  const costmap::SurfacePatch patch{.elevation_m = floatsOf(layers.heights, "heights", grid),
                                    .rock_abundance = floatsOf(layers.rocks, "rocks", grid),
                                    .classes = bytesOf(layers.classes, "classes", grid),
                                    .keep_out = bytesOf(layers.keep_out, "keep_out", grid)};
  const py::gil_scoped_release released;
  session_->map.patch(patch);
}

std::size_t PythonMap::learn(const py::object& given) {
  const auto lock = held(*session_);
  std::size_t rows = 0;
  withTable(given, [&](const std::string& path, const std::string& name) {
    const py::gil_scoped_release released;
    terramech::Telemetry telemetry = terramech::readTelemetry(path);
    telemetry.source = name;
    rows = session_->map.learnPart(telemetry);
  });
  return rows;
}

void PythonMap::settle() {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  session_->map.settle();
}

std::unique_ptr<PythonMap> PythonMap::read(const std::string& path, int threads) {
  requireThreads(threads);
  const py::gil_scoped_release released;
  const InputRecord record;
  auto map = std::make_unique<PythonMap>(Map(readBuiltMap(path, {.threads = threads})));
  map->files_ = filesRead();
  for (InputFile& file : map->files_) file.role = file.path == path ? "map" : file.role;
  const std::vector<InputFile>& before = map->map().elevation().files;
  map->files_.insert(map->files_.end(), before.begin(), before.end());
  return map;
}

std::unique_ptr<PythonMap> PythonMap::fromFiles(const SiteFiles& files, int threads) {
  requireThreads(threads);
  const std::string& path = files.elevation.path;
  if (costmap::octomapType(path) == "TraversabilityTree")
    throw InputError({path, "is a built map with its own rover and soils", "read it with Map.read()"});
  std::vector<std::string> notes;
  std::unique_ptr<PythonMap> map;
  {
    const py::gil_scoped_release released;
    Site site = readSite(
        files, {.threads = threads, .note = [&notes](std::string_view line) { notes.emplace_back(line); }});
    std::vector<InputFile> read = site.layers.elevation.files;
    map = std::make_unique<PythonMap>(Map(std::move(site)));
    map->files_ = std::move(read);
  }
  warn(notes);
  return map;
}

void PythonMap::save(const std::string& path) const {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  session_->map.save(path);
}

void PythonMap::writeRoute(const Route& route, const std::string& path) const {
  if (route.status != RouteStatus::Found)
    throw py::value_error("route: its status is " + std::string(name(route.status)) + ", must be found");
  std::vector<std::string> notes;
  const auto document = routeGeoJson(route, map().elevation(), originOf(map(), files_, settings_.seed));
  planner::writeRoute(path, document, map().elevation(),
                      [&notes](std::string_view line) { notes.emplace_back(line); });
  warn(notes);
}

Route PythonMap::plan(const PlannerSettings& settings, const PlanRequest& request,
                      const py::object& progress) {
  const auto lock = held(*session_);
  if (!(settings == settings_)) session_->planner = Planner(settings);
  settings_ = settings;
  Route route;
  inBackground(
      [&](const ProgressMonitor& watch) {
        PlanRequest asked = request;
        asked.watch = watch;
        route = session_->planner.plan(session_->map, asked);
      },
      progress);
  return route;
}

costmap::Explanation PythonMap::explain(maps::Point place, std::optional<double> heading_rad) const {
  const auto lock = held(*session_);
  return session_->map.explain(place, heading_rad);
}

Score PythonMap::score(const std::vector<maps::Point>& path, bool prove, int threads,
                       const py::object& progress) const {
  const auto lock = held(*session_);
  Planner planner({.threads = threads});
  Score score;
  inBackground(
      [&](const ProgressMonitor& watch) {
        score = planner.score(map(), path, {.prove = prove, .watch = watch});
      },
      progress);
  return score;
}

PythonMap PythonMap::moved(maps::Cell tiles) const {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  PythonMap next(session_->map.moved(tiles));
  next.files_ = files_;
  return next;
}

}  // namespace talus::planner
