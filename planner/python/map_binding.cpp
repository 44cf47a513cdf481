#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_frame.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/planner/python/python_map.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/site/site.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace py = pybind11;
using namespace pybind11::literals;

namespace talus::planner {
namespace {

using Pair = std::pair<double, double>;
using Path = std::filesystem::path;

maps::Point pointOf(const Pair& given) {
  return {given.first, given.second};
}

const costmap::TraversabilityMap& mapOf(const py::object& self) {
  return self.cast<const PythonMap&>().map();
}

// Runs work(map) with exclusive access and without the GIL.
template <typename Work>
auto alone(const PythonMap& map, const Work& work) {
  const auto lock = map.held();
  const py::gil_scoped_release released;
  return work(map.session->map);
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

using costmap::TravelPolicy;

// The thresholds of a mission file by their names there, then those that only options of the program set.
constexpr std::pair<const char*, double TravelPolicy::*> kNumbers[] = {
    {"slope_margin_rad", &TravelPolicy::slope_margin_rad},
    {"sinkage_threshold", &TravelPolicy::sinkage_threshold},
    {"sinkage_critical", &TravelPolicy::sinkage_critical},
    {"max_immobilisation", &TravelPolicy::max_immobilisation},
    {"time_weight_W", &TravelPolicy::time_weight_W},
    {"risk_weight_J", &TravelPolicy::risk_weight_J},
    {"entrapment", &TravelPolicy::entrapment},
    {"pose_error_m", &TravelPolicy::pose_error_m},
};
constexpr std::pair<const char*, bool TravelPolicy::*> kFlags[] = {
    {"allow_marginal", &TravelPolicy::allow_marginal},
    {"allow_dangerous", &TravelPolicy::allow_dangerous},
    {"allow_unknown", &TravelPolicy::allow_unknown},
    {"unmonitored", &TravelPolicy::unmonitored},
};

py::dict thresholdsOf(const TravelPolicy& policy) {
  py::dict all;
  for (const auto& [name, field] : kNumbers) all[name] = policy.*field;
  for (const auto& [name, field] : kFlags) all[name] = policy.*field;
  return all;
}

TravelPolicy policyOf(const py::dict& thresholds) {
  TravelPolicy policy;
  const py::dict known = thresholdsOf(policy);
  for (const auto& [key, value] : thresholds) {
    const std::string word = py::str(key);
    if (!known.contains(key)) {
      std::vector<std::string> names;
      for (const auto& [name, ignored] : known) names.push_back(py::str(name));
      const std::string nearest = nearestName(word, names);
      throw py::value_error(
          "thresholds: '" + word + "' is not known; " +
          (nearest.empty() ? "Map.thresholds lists them" : "did you mean " + nearest + "?"));
    }
    const bool flag = py::isinstance<py::bool_>(known[key]);
    if (flag != py::isinstance<py::bool_>(value) || (!flag && PyNumber_Check(value.ptr()) == 0))
      throw py::type_error("thresholds: " + word + " must be " + (flag ? "True or False" : "a number"));
    for (const auto& [name, field] : kNumbers)
      if (word == name) policy.*field = value.cast<double>();
    for (const auto& [name, field] : kFlags)
      if (word == name) policy.*field = value.cast<bool>();
  }
  return policy;
}

// A place inside the map: (x_m, y_m), or a text as in the program.
maps::Point placeOf(const py::object& given, const maps::ElevationMap& map, const std::string& name) {
  if (py::isinstance<py::str>(given)) return maps::readPlace(given.cast<std::string>(), map, name);
  try {
    const auto [x, y] = given.cast<Pair>();
    return {x, y};
  } catch (const py::cast_error&) {
    throw py::type_error(name + " must be (x_m, y_m), or a text: 'x,y', 'LATd,LONd' or a file");
  }
}

// The layers of a map or of a patch; None where there is none.
struct Layers {
  const py::object &heights, &classes, &rocks, &keep_out;
};

Map built(const Layers& layers, const py::dict& costs, costmap::GroundModel::Parts parts,
          const py::object& soils, const maps::Grid& grid, const std::string& crs, int threads) {
  requireThreads(threads);
  costmap::MapLayers made;
  made.elevation = {.elevation_m = floatsOf(layers.heights, "heights", grid),
                    .georeference = georeferenceOf(crs, grid),
                    .source = "heights"};
  made.classes = bytesOf(layers.classes, "classes", grid);
  if (made.classes.empty() && py::isinstance<py::dict>(soils) && soils.cast<py::dict>().size() > 1)
    throw py::value_error("classes: needed where soils has more than one class");
  made.rock_abundance = floatsOf(layers.rocks, "rocks", grid);
  made.keep_out = bytesOf(layers.keep_out, "keep_out", grid);
  made.costs = costsOf(costs, grid);
  parts.classes = classesOf(soils, parts.rover);
  const py::gil_scoped_release released;
  return Map({.layers = std::move(made),
              .ground = costmap::GroundModel(std::move(parts)),
              .options = {.threads = threads}});
}

void patch(const PythonMap& map, const Layers& layers, maps::Point south_west) {
  const auto lock = map.held();
  const py::object* first = nullptr;
  for (const py::object* each : {&layers.heights, &layers.classes, &layers.rocks, &layers.keep_out})
    if (!each->is_none() && first == nullptr) first = each;
  if (first == nullptr) throw py::value_error("patch: give heights, classes, rocks or keep_out");
  const maps::Grid grid =
      gridOf(*first, "patch", {.resolution_m = map.map().grid().resolution_m, .south_west = south_west});
  const costmap::SurfacePatch seen{.elevation_m = floatsOf(layers.heights, "heights", grid),
                                   .rock_abundance = floatsOf(layers.rocks, "rocks", grid),
                                   .classes = bytesOf(layers.classes, "classes", grid),
                                   .keep_out = bytesOf(layers.keep_out, "keep_out", grid)};
  const py::gil_scoped_release released;
  map.session->map.patch(seen);
}

std::size_t learn(const PythonMap& map, const py::object& given) {
  const auto lock = map.held();
  std::size_t rows = 0;
  withTable(given, [&](const std::string& path, const std::string& name) {
    const py::gil_scoped_release released;
    terramech::Telemetry telemetry = terramech::readTelemetry(path);
    telemetry.source = name;
    rows = map.session->map.learnPart(telemetry);
  });
  return rows;
}

PythonMap read(const Path& path, int threads) {
  requireThreads(threads);
  const py::gil_scoped_release released;
  const InputRecord record;
  PythonMap map(Map(readBuiltMap(path.string(), {.threads = threads})));
  map.files = filesRead();
  for (InputFile& file : map.files) file.role = file.path == path ? "map" : file.role;
  const std::vector<InputFile>& before = map.map().elevation().files;
  map.files.insert(map.files.end(), before.begin(), before.end());
  return map;
}

PythonMap fromFiles(const SiteFiles& files, int threads) {
  requireThreads(threads);
  const std::string& path = files.elevation.path;
  if (costmap::octomapType(path) == "TraversabilityTree")
    throw InputError({path, "is a built map with its own rover and soils", "read it with Map.read()"});
  std::vector<std::string> notes;
  const auto made = [&] {
    const py::gil_scoped_release released;
    Site site = readSite(
        files, {.threads = threads, .note = [&notes](std::string_view line) { notes.emplace_back(line); }});
    std::vector<InputFile> read = site.layers.elevation.files;
    return PythonMap(Map(std::move(site)), std::move(read));
  };
  PythonMap map = made();
  warn(notes);
  return map;
}

void write(const PythonMap& map, const Route& route, const Path& path) {
  if (!route.found())
    throw py::value_error("route: its status is " + std::string(name(route.status)) + ", must be found");
  std::vector<std::string> notes;
  writeRoute(path.string(),
             routeGeoJson(route, map.map().elevation(), originOf(map.map(), map.files, map.settings.seed)),
             map.map().elevation(), [&notes](std::string_view line) { notes.emplace_back(line); });
  warn(notes);
}

Score score(const PythonMap& map, const py::object& path, bool prove, int threads,
            const py::object& progress) {
  const auto lock = map.held();
  const std::vector<maps::Point> points = pointsOf(path, "path");
  Planner planner({.threads = threads});
  Score score;
  inBackground(
      [&](const ProgressMonitor& watch) {
        score = planner.score(map.map(), points, {.prove = prove, .watch = watch});
      },
      progress);
  return score;
}

Route plan(PythonMap& map, const PlannerSettings& settings, PlanRequest request, const py::object& progress) {
  const auto lock = map.held();
  if (!(settings == map.settings)) map.session->planner = Planner(settings);
  map.settings = settings;
  Route route;
  inBackground(
      [&](const ProgressMonitor& watch) {
        request.watch = watch;
        route = map.session->planner.plan(map.session->map, request);
      },
      progress);
  return route;
}

// Properties of all cells, computed once; the columns are views of one block of memory.
py::dict beliefs(const py::object& self) {
  const costmap::TraversabilityMap& map = mapOf(self);
  const maps::Grid& grid = map.grid();
  auto cells = std::make_unique<std::vector<costmap::CellBelief>>();
  {
    const py::gil_scoped_release released;
    cells->reserve(grid.size());
    costmap::PlaceBeliefs place(map);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) cells->push_back(place.at({column, row}));
  }
  const costmap::CellBelief* first = cells->data();
  const py::capsule owner(cells.release(),
                          [](void* held) { delete static_cast<std::vector<costmap::CellBelief>*>(held); });
  const auto step = static_cast<py::ssize_t>(sizeof(costmap::CellBelief));
  py::dict columns;
  const auto add = [&](const char* name, const auto* value) {
    columns[name] = viewOf(value, {grid.height, grid.width}, {grid.width * step, step}, owner);
  };
  add("pull_mean", &first->pull_mean);
  add("pull_std", &first->pull_std);
  add("sinkage_mean", &first->sinkage_mean);
  add("sinkage_std", &first->sinkage_std);
  add("evidence", &first->evidence);
  add("category", &first->category);
  add("hazards", reinterpret_cast<const std::uint8_t*>(&first->hazards));
  return columns;
}

py::array layerOf(const py::object& self, const std::string& name) {
  for (const costmap::CostLayer& layer : mapOf(self).surface().costLayers())
    if (layer.name == name) return viewOf(layer.added_J_per_m, self);
  throw py::key_error("the map has no layer '" + name + "'");
}

std::vector<std::tuple<double, double, double, double, std::string>> dangersOf(const py::object& self,
                                                                               const py::object& path,
                                                                               double quantile) {
  std::vector<std::tuple<double, double, double, double, std::string>> out;
  const auto published = mapOf(self).published();
  for (const Danger& d : dangers(*published, pointsOf(path, "path"), quantile))
    out.emplace_back(d.place.x_m, d.place.y_m, d.along_m, d.probability, d.reason);
  return out;
}

// Values of the cells as an array that owns them.
template <typename T>
py::array_t<T> arrayFrom(const maps::Raster<T>& raster) {
  py::array_t<T> out({raster.grid().height, raster.grid().width});
  std::copy(raster.values().begin(), raster.values().end(), out.mutable_data());
  return out;
}

py::array heightsFrom(const py::object& given, std::pair<int, int> shape, double resolution_m,
                      const Pair& south_west, const maps::HeightChoice& choice) {
  const std::vector<maps::CloudPoint> cloud = cloudOf(given, "points");
  if (shape.first < 1 || shape.second < 1 || shape.first > 65536 || shape.second > 65536)
    throw py::value_error("shape must be (rows, columns) of 1 to 65536 each");
  if (!(resolution_m > 0.0))
    throw py::value_error("resolution_m = " + std::to_string(resolution_m) + ", must be > 0");
  maps::Raster<float> heights;
  {
    const py::gil_scoped_release released;
    heights = maps::heightsOf(cloud,
                              {.width = shape.second,
                               .height = shape.first,
                               .resolution_m = resolution_m,
                               .south_west = pointOf(south_west)},
                              choice);
  }
  return arrayFrom(heights);
}

py::dict explained(const PythonMap& map, const py::object& place, std::optional<double> heading_rad) {
  const auto lock = map.held();
  const maps::ElevationMap& elevation = map.map().elevation();
  const maps::Point at = maps::locate(placeOf(place, elevation, "place"), elevation, "place");
  const costmap::Explanation why = map.session->map.explain(at, heading_rad);
  const maps::Cell cell = *map.map().grid().cellAt(at);
  py::list causes;
  for (const costmap::Cause& cause : why.causes)
    causes.append(py::dict("name"_a = cause.name, "value"_a = cause.value, "std"_a = cause.std,
                           "source"_a = cause.source, "remark"_a = cause.remark));
  return py::dict("category"_a = terramech::name(why.category), "probability"_a = why.probability,
                  "verdict"_a = why.verdict, "x_m"_a = at.x_m, "y_m"_a = at.y_m, "column"_a = cell.column,
                  "row"_a = cell.row, "causes"_a = causes);
}

void bindViews(py::class_<PythonMap>& map) {
  map.def_property_readonly(
         "shape", [](const PythonMap& m) { return std::pair(m.map().grid().height, m.map().grid().width); })
      .def_property_readonly("resolution_m", [](const PythonMap& m) { return m.map().grid().resolution_m; })
      .def_property_readonly("south_west",
                             [](const PythonMap& m) {
                               return Pair(m.map().grid().south_west.x_m, m.map().grid().south_west.y_m);
                             })
      .def_property_readonly(
          "crs",
          [](const PythonMap& m) {
            const auto& at = m.map().elevation().georeference;
            return at ? at->system().name : "local";
          },
          "Name of the coordinate reference system; local: x and y are local metres.")
      .def_property_readonly(
          "body",
          [](const PythonMap& m) -> std::optional<std::string> {
            const auto& at = m.map().elevation().georeference;
            return at ? std::optional(at->body()) : std::nullopt;
          },
          "Earth, Moon, Mars, ...; None without a coordinate reference system.")
      .def_property_readonly(
          "thresholds", [](const PythonMap& m) { return thresholdsOf(m.map().model().parts().policy); },
          "Thresholds and weights, by the names of a mission file.")
      .def_property_readonly("version", [](const PythonMap& m) { return m.map().published()->version(); })
      .def_property_readonly(
          "heights",
          [](const py::object& self) -> py::array {
            return viewOf(mapOf(self).elevation().elevation_m, self);
          },
          "Heights [m], row 0 in the south; a read-only view that shows later patches.")
      .def_property_readonly(
          "classes",
          [](const py::object& self) -> py::array { return viewOf(mapOf(self).surface().classes(), self); },
          "Class numbers, 255 where unknown; a read-only view, of shape (0, 0) where the map has no classes.")
      .def("layer", &layerOf, "name"_a, "Joules a metre that a layer adds; a read-only view.")
      .def(
          "categories",
          [](const PythonMap& m) -> py::array { return arrayFrom(m.map().costs().categories()); },
          "Category of each cell in its worst heading: 0 safe, 1 marginal, 2 dangerous, 3 unknown.")
      .def("explain", &explained, "place"_a, "heading_rad"_a = py::none(),
           "Category of a cell and its causes, as `talus explain`; without a heading in the worst one.")
      .def("score", &score, "path"_a, py::kw_only(), "prove"_a = false, "threads"_a = 1,
           "progress"_a = py::none(),
           R"(What a path of shape (n, 2) costs under the planners' cost function, as `talus score`.
prove: also the best route between its ends. The GIL is released, Ctrl-C ends it.)")
      .def("beliefs", &beliefs,
           "Columns by cell: pull_mean, pull_std, sinkage_mean, sinkage_std, evidence, category, hazards.")
      .def("dangers", &dangersOf, "path"_a, "quantile"_a = 0.05,
           "Where a path of shape (n, 2) is not safe: (x_m, y_m, along_m, probability, reason) each.");
}

// Adds methods that read and write map and route files.
void addFiles(py::class_<PythonMap>& map) {
  map.def_static(
         "read", &read, "path"_a, py::kw_only(), "threads"_a = 1,
         R"(A map that `talus costmap`, `talus update` or save() wrote, with its rover, soils and evidence.)")
      .def(
          "save",
          [](const PythonMap& m, const Path& path) {
            alone(m, [&path](const Map& own) { own.save(path.string()); });
          },
          "path"_a, "Writes the map for read() and `talus plan --map`: the whole file or none.")
      .def(
          "settle", [](const PythonMap& m) { alone(m, [](Map& own) { own.settle(); }); },
          R"(Judges all rows learned since the map was made or read again, by what all of them say of the sensors:
the map is then that of one file of these rows.)")
      .def(
          "write_route", &write, "route"_a, "path"_a,
          R"(Writes a route that plan() found here, as `talus plan -o`: .geojson, .gpkg, .gpx, .kml or .csv.)");
}

// Adds from_files().
void addSite(py::class_<PythonMap>& map) {
  map.def_static(
      "from_files",
      [](const Path& elevation, const std::string& rover, const std::string& soil, const std::string& soils,
         const std::string& model, const std::string& classes, const std::string& rocks,
         const std::vector<std::string>& keep_out, const std::map<std::string, std::string>& layers,
         std::optional<double> resolution_m, const std::string& window, std::optional<int> band,
         std::optional<double> nodata, std::optional<double> vertical_scale, bool keep_holes, bool ignore_crs,
         bool allow_vrt, std::optional<double> below_m, const std::string& cost_curve, double footprint_m,
         const py::dict& thresholds, int threads) {
        SiteFiles files{.elevation = elevation.string(),
                        .classes = classes,
                        .rocks = rocks,
                        .keep_out = keep_out,
                        .soils = soils,
                        .soil = soil,
                        .model = model,
                        .rover = rover,
                        .cost_curve = cost_curve,
                        .footprint_m = footprint_m,
                        .policy = policyOf(thresholds)};
        for (const auto& [name, path] : layers) files.costs.push_back(name + "=" + path);
        files.elevation.window = window;
        files.elevation.below_m = below_m;
        files.elevation.read = {.band = band,
                                .resolution_m = resolution_m,
                                .nodata = nodata,
                                .keep_holes = keep_holes,
                                .vertical_scale = vertical_scale,
                                .ignore_crs = ignore_crs,
                                .allow_vrt = allow_vrt};
        return fromFiles(files, threads);
      },
      R"(A map from the files that `talus costmap` reads, with its options: any GDAL raster, .npz or OctoMap of
heights; rasters of classes and rocks, vector files keep_out, layers by name, rover, soil, soils, model
by name or YAML file. What is assumed is a UserWarning.)",
      "elevation"_a, py::kw_only(), "rover"_a = "", "soil"_a = "", "soils"_a = "", "model"_a = "",
      "classes"_a = "", "rocks"_a = "", "keep_out"_a = std::vector<std::string>{}, "layers"_a = py::dict(),
      "resolution_m"_a = py::none(), "window"_a = "", "band"_a = py::none(), "nodata"_a = py::none(),
      "vertical_scale"_a = py::none(), "keep_holes"_a = false, "ignore_crs"_a = false, "allow_vrt"_a = false,
      "below_m"_a = py::none(), "cost_curve"_a = "", "footprint_m"_a = 0.0, "thresholds"_a = py::dict(),
      "threads"_a = 1);
}

// Adds plan().
void addPlan(py::class_<PythonMap>& map) {
  map.def(
      "plan",
      [](PythonMap& m, const py::object& start, const py::object& goal, const std::string& planner_name,
         double tolerance_m, const std::vector<py::object>& via, std::optional<double> start_heading_rad,
         std::optional<double> goal_heading_rad, std::optional<double> max_risk,
         std::optional<double> time_limit_s, bool prove, std::uint64_t seed, int threads,
         const py::object& progress) {
        PlannerSettings settings{.planner = planner_name, .seed = seed, .threads = threads};
        if (time_limit_s) settings.time_limit_s = *time_limit_s;
        const maps::ElevationMap& elevation = m.map().elevation();
        PlanRequest request{.start = placeOf(start, elevation, "start"),
                            .goal = placeOf(goal, elevation, "goal"),
                            .tolerance_m = tolerance_m,
                            .start_heading_rad = start_heading_rad,
                            .goal_heading_rad = goal_heading_rad,
                            .prove = prove};
        for (const py::object& place : via) request.via.push_back(placeOf(place, elevation, "via"));
        if (max_risk) request.risk_limit = RiskLimit{.immobilisation = *max_risk};
        return planner::plan(m, settings, std::move(request), progress);
      },
      R"(A route over all that is known now; the GIL is released, Ctrl-C ends it. Places: (x_m, y_m), or a text
as in `talus plan`. progress: called with 0 to 1. prove: also the best lower bound and a search over
points of cells, which takes longer.)",
      "start"_a, "goal"_a, py::kw_only(), "planner"_a = "", "tolerance_m"_a = 0.0, "via"_a = py::tuple(),
      "start_heading_rad"_a = py::none(), "goal_heading_rad"_a = py::none(), "max_risk"_a = py::none(),
      "time_limit_s"_a = py::none(), "prove"_a = false, "seed"_a = 1, "threads"_a = 1,
      "progress"_a = py::none());
}

void addHeights(py::module_& module) {
  module.def(
      "heights_from_points",
      [](const py::object& points, std::pair<int, int> shape, double resolution_m, const Pair& south_west,
         double percentile, std::size_t least_points) {
        return heightsFrom(points, shape, resolution_m, south_west, {percentile, least_points});
      },
      R"(Heights on a grid from a point cloud of shape (n, 3): in each cell the percentile of its points by
height, NaN where it has fewer than least_points.)",
      "points"_a, "shape"_a, py::kw_only(), "resolution_m"_a, "south_west"_a, "percentile"_a = 1.0,
      "least_points"_a = 1);
}

}  // namespace

void bindMap(py::module_& module) {
  py::class_<PythonMap> map(module, "Map",
                            "What is known of the ground, estimates of its strength, and routes over it. "
                            "Arrays have row 0 in the south.");
  map.def(
         py::init([](const py::object& heights, double resolution_m, const py::object& rover,
                     const py::object& soils, const py::object& classes, const py::object& rocks,
                     const py::object& keep_out, const py::dict& layers, const Pair& south_west,
                     const std::string& crs, const py::dict& thresholds, bool allow_unknown, int threads) {
           costmap::TravelPolicy policy = policyOf(thresholds);
           policy.allow_unknown |= allow_unknown;
           const maps::Grid grid = gridOf(heights, "heights", {resolution_m, pointOf(south_west)});
           return PythonMap(built({heights, classes, rocks, keep_out}, layers,
                                  {.rover = roverOf(rover), .classes = {}, .policy = policy}, soils, grid,
                                  crs, threads));
         }),
         R"(heights: float32 or float64, NaN where not observed. soils: a name or Soil, or a dict of class numbers
to them. layers: joules a metre to add by name; inf is refused, NaN not known. crs: EPSG code or WKT;
without it x and y are local metres. thresholds: as in a mission file.)",
         "heights"_a, py::kw_only(), "resolution_m"_a, "rover"_a, "soils"_a, "classes"_a = py::none(),
         "rocks"_a = py::none(), "keep_out"_a = py::none(), "layers"_a = py::dict(),
         "south_west"_a = Pair(0.0, 0.0), "crs"_a = "", "thresholds"_a = py::dict(),
         "allow_unknown"_a = false, "threads"_a = 1)
      .def(
          "patch",
          [](const PythonMap& m, const py::object& heights, const Pair& south_west, const py::object& classes,
             const py::object& rocks, const py::object& keep_out) {
            patch(m, {heights, classes, rocks, keep_out}, pointOf(south_west));
          },
          "New ground in a window on the map's cells: NaN, or class 255, leaves a cell as it is.",
          "heights"_a = py::none(), py::kw_only(), "south_west"_a, "classes"_a = py::none(),
          "rocks"_a = py::none(), "keep_out"_a = py::none())
      .def(
          "learn", &learn, "telemetry"_a,
          R"(Wheel telemetry: the path of a CSV, or a dict of its columns as arrays, whole moments in order of time,
NaN where not measured. Returns how many rows taught something.)")
      .def(
          "move",
          [](const PythonMap& m, int east, int north) {
            alone(m, [&](Map& own) { own.move({east, north}); });
          },
          "east"_a, "north"_a,
          "Moves the window by so many tiles of 64 cells further east and north; the drive under way goes "
          "on.")
      .def("__repr__", [](const PythonMap& m) {
        const maps::Grid& g = m.map().grid();
        return "<talus.Map " + std::to_string(g.height) + " x " + std::to_string(g.width) + " cells of " +
               std::to_string(g.resolution_m) + " m>";
      });
  addFiles(map);
  addSite(map);
  addPlan(map);
  bindViews(map);
  addHeights(module);
}

}  // namespace talus::planner
