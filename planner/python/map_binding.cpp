#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <talus/common/nearest_name.hpp>
#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/maps/grid/point_heights.hpp>
#include <talus/maps/vector/place_reader.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/planner/python/python_map.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using Pair = std::pair<double, double>;

const costmap::TraversabilityMap& mapOf(const py::object& self) {
  return self.cast<const PythonMap&>().map();
}

// The thresholds of a mission file by their names there, then those that only options of the program set.
constexpr std::pair<const char*, double costmap::TravelPolicy::*> kNumbers[] = {
    {"slope_margin_rad", &costmap::TravelPolicy::slope_margin_rad},
    {"sinkage_threshold", &costmap::TravelPolicy::sinkage_threshold},
    {"sinkage_critical", &costmap::TravelPolicy::sinkage_critical},
    {"max_immobilisation", &costmap::TravelPolicy::max_immobilisation},
    {"time_weight_W", &costmap::TravelPolicy::time_weight_W},
    {"risk_weight_J", &costmap::TravelPolicy::risk_weight_J},
    {"entrapment", &costmap::TravelPolicy::entrapment},
    {"pose_error_m", &costmap::TravelPolicy::pose_error_m},
};
constexpr std::pair<const char*, bool costmap::TravelPolicy::*> kFlags[] = {
    {"allow_marginal", &costmap::TravelPolicy::allow_marginal},
    {"allow_dangerous", &costmap::TravelPolicy::allow_dangerous},
    {"allow_unknown", &costmap::TravelPolicy::allow_unknown},
    {"unmonitored", &costmap::TravelPolicy::unmonitored},
};

py::dict thresholdsOf(const costmap::TravelPolicy& policy) {
  py::dict all;
  for (const auto& [name, field] : kNumbers) all[name] = policy.*field;
  for (const auto& [name, field] : kFlags) all[name] = policy.*field;
  return all;
}

costmap::TravelPolicy policyOf(const py::dict& thresholds) {
  costmap::TravelPolicy policy;
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
                               .south_west = {south_west.first, south_west.second}},
                              choice);
  }
  return arrayFrom(heights);
}

py::dict explained(const PythonMap& map, const py::object& place, std::optional<double> heading_rad) {
  const maps::ElevationMap& elevation = map.map().elevation();
  const maps::Point at = maps::locate(placeOf(place, elevation, "place"), elevation, "place");
  const costmap::Explanation why = map.explain(at, heading_rad);
  const maps::Cell cell = *map.map().grid().cellAt(at);
  py::list causes;
  for (const costmap::Cause& cause : why.causes)
    causes.append(py::dict(py::arg("name") = cause.name, py::arg("value") = cause.value,
                           py::arg("std") = cause.std, py::arg("source") = cause.source,
                           py::arg("remark") = cause.remark));
  return py::dict(py::arg("category") = terramech::name(why.category),
                  py::arg("probability") = why.probability, py::arg("verdict") = why.verdict,
                  py::arg("x_m") = at.x_m, py::arg("y_m") = at.y_m, py::arg("column") = cell.column,
                  py::arg("row") = cell.row, py::arg("causes") = causes);
}

struct Asked {
  std::optional<double> start_heading_rad, goal_heading_rad, max_risk, time_limit_s;
  std::vector<py::object> via;
  double tolerance_m;
  bool prove;
};

PlanRequest requestOf(const maps::ElevationMap& map, const py::object& start, const py::object& goal,
                      const Asked& asked) {
  PlanRequest request{.start = placeOf(start, map, "start"),
                      .goal = placeOf(goal, map, "goal"),
                      .tolerance_m = asked.tolerance_m,
                      .start_heading_rad = asked.start_heading_rad,
                      .goal_heading_rad = asked.goal_heading_rad,
                      .prove = asked.prove};
  for (const py::object& place : asked.via) request.via.push_back(placeOf(place, map, "via"));
  if (asked.max_risk) request.risk_limit = RiskLimit{.immobilisation = *asked.max_risk};
  return request;
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
      .def("layer", &layerOf, py::arg("name"), "Joules a metre that a layer adds; a read-only view.")
      .def(
          "categories",
          [](const PythonMap& m) -> py::array { return arrayFrom(m.map().costs().categories()); },
          "Category of each cell in its worst heading: 0 safe, 1 marginal, 2 dangerous, 3 unknown.")
      .def("explain", &explained, py::arg("place"), py::arg("heading_rad") = py::none(),
           "Category of a cell and its causes, as `talus explain`; without a heading in the worst one.")
      .def(
          "score",
          [](const PythonMap& m, const py::object& path, bool prove, int threads,
             const py::object& progress) {
            return m.score(pointsOf(path, "path"), prove, threads, progress);
          },
          "What a path of shape (n, 2) costs under the planners' cost function, as `talus score`. prove: "
          "also the "
          "best\n"
          "route between its ends. The GIL is released, Ctrl-C ends it.",
          py::arg("path"), py::kw_only(), py::arg("prove") = false, py::arg("threads") = 1,
          py::arg("progress") = py::none())
      .def("beliefs", &beliefs,
           "Columns by cell: pull_mean, pull_std, sinkage_mean, sinkage_std, evidence, category, hazards.")
      .def("dangers", &dangersOf, py::arg("path"), py::arg("quantile") = 0.05,
           "Where a path of shape (n, 2) is not safe: (x_m, y_m, along_m, probability, reason) each.");
}

// Adds methods that read and write map and route files.
void addFiles(py::class_<PythonMap>& map) {
  using Path = std::filesystem::path;
  map.def_static(
         "read", [](const Path& path, int threads) { return PythonMap::read(path.string(), threads); },
         "A map that `talus costmap`, `talus update` or save() wrote, with its rover, soils and what wheels "
         "taught.",
         py::arg("path"), py::kw_only(), py::arg("threads") = 1)
      .def(
          "save", [](const PythonMap& m, const Path& path) { m.save(path.string()); },
          "Writes the map for read() and `talus plan --map`: the whole file or none.", py::arg("path"))
      .def("settle", &PythonMap::settle,
           "Judges all rows learned since the map was made or read again, by what all of them say of the "
           "sensors: the "
           "map\n"
           "is then that of one file of these rows.")
      .def(
          "write_route",
          [](const PythonMap& m, const Route& route, const Path& path) {
            m.writeRoute(route, path.string());
          },
          "Writes a route that plan() found here, as `talus plan -o`: the ending selects .geojson, .gpkg, "
          ".gpx, "
          ".kml or .csv.",
          py::arg("route"), py::arg("path"));
}

// Adds from_files().
void addSite(py::class_<PythonMap>& map) {
  using Path = std::filesystem::path;
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
        return PythonMap::fromFiles(files, threads);
      },
      "A map from the files that `talus costmap` reads, with its options: any GDAL raster, .npz or OctoMap "
      "of heights; "
      "rasters\n"
      "of classes and rocks, vector files keep_out, layers by name, rover, soil, soils, model by name or "
      "YAML file. "
      "What is\n"
      "assumed is a UserWarning.",
      py::arg("elevation"), py::kw_only(), py::arg("rover") = "", py::arg("soil") = "", py::arg("soils") = "",
      py::arg("model") = "", py::arg("classes") = "", py::arg("rocks") = "",
      py::arg("keep_out") = std::vector<std::string>{}, py::arg("layers") = py::dict(),
      py::arg("resolution_m") = py::none(), py::arg("window") = "", py::arg("band") = py::none(),
      py::arg("nodata") = py::none(), py::arg("vertical_scale") = py::none(), py::arg("keep_holes") = false,
      py::arg("ignore_crs") = false, py::arg("allow_vrt") = false, py::arg("below_m") = py::none(),
      py::arg("cost_curve") = "", py::arg("footprint_m") = 0.0, py::arg("thresholds") = py::dict(),
      py::arg("threads") = 1);
}

// Adds plan().
void addPlan(py::class_<PythonMap>& map) {
  map.def(
      "plan",
      [](PythonMap& m, const py::object& start, const py::object& goal, const std::string& planner,
         double tolerance_m, const std::vector<py::object>& via, std::optional<double> start_heading_rad,
         std::optional<double> goal_heading_rad, std::optional<double> max_risk,
         std::optional<double> time_limit_s, bool prove, std::uint64_t seed, int threads,
         const py::object& progress) {
        PlannerSettings settings{.planner = planner, .seed = seed, .threads = threads};
        if (time_limit_s) settings.time_limit_s = *time_limit_s;
        return m.plan(
            settings,
            requestOf(m.map().elevation(), start, goal,
                      {start_heading_rad, goal_heading_rad, max_risk, time_limit_s, via, tolerance_m, prove}),
            progress);
      },
      "A route over all that is known now; the GIL is released, Ctrl-C ends it. Places: (x_m, y_m), or a "
      "text as "
      "in `talus plan`.\n"
      "progress: called with 0 to 1. prove: also the best lower bound and a search over points of cells, "
      "which takes longer.",
      py::arg("start"), py::arg("goal"), py::kw_only(), py::arg("planner") = "", py::arg("tolerance_m") = 0.0,
      py::arg("via") = py::tuple(), py::arg("start_heading_rad") = py::none(),
      py::arg("goal_heading_rad") = py::none(), py::arg("max_risk") = py::none(),
      py::arg("time_limit_s") = py::none(), py::arg("prove") = false, py::arg("seed") = 1,
      py::arg("threads") = 1, py::arg("progress") = py::none());
}

void addHeights(py::module_& module) {
  module.def(
      "heights_from_points",
      [](const py::object& points, std::pair<int, int> shape, double resolution_m, const Pair& south_west,
         double percentile, std::size_t least_points) {
        return heightsFrom(points, shape, resolution_m, south_west, {percentile, least_points});
      },
      "Heights on a grid from a point cloud of shape (n, 3): in each cell the percentile of its points by "
      "height, NaN\n"
      "where it has fewer than least_points.",
      py::arg("points"), py::arg("shape"), py::kw_only(), py::arg("resolution_m"), py::arg("south_west"),
      py::arg("percentile") = 1.0, py::arg("least_points") = 1);
}

}  // namespace

void bindMap(py::module_& module) {
  py::class_<PythonMap> map(module, "Map",
                            "What is known of the ground, estimates of its strength, and routes over it. "
                            "Arrays have row 0 in the south.");
  map.def(py::init([](const py::object& heights, double resolution_m, const py::object& rover,
                      const py::object& soils, const py::object& classes, const py::object& rocks,
                      const py::object& keep_out, const py::dict& layers, const Pair& south_west,
                      const std::string& crs, const py::dict& thresholds, bool allow_unknown, int threads) {
            costmap::TravelPolicy policy = policyOf(thresholds);
            policy.allow_unknown |= allow_unknown;
            return std::make_unique<PythonMap>(
                PythonMap::Layers{heights, classes, rocks, keep_out, layers},
                PythonMap::Ground{.rover = roverOf(rover),
                                  .soils = soils,
                                  .policy = policy,
                                  .resolution_m = resolution_m,
                                  .south_west = {south_west.first, south_west.second},
                                  .crs = crs,
                                  .threads = threads});
          }),
          "heights: float32 or float64, NaN where not observed. soils: a name or Soil, or a dict of class "
          "numbers to\n"
          "them. layers: joules a metre to add by name; inf is refused, NaN not known. crs: EPSG code or "
          "WKT; without "
          "it x and y are\n"
          "local metres. thresholds: as in a mission file.",
          py::arg("heights"), py::kw_only(), py::arg("resolution_m"), py::arg("rover"), py::arg("soils"),
          py::arg("classes") = py::none(), py::arg("rocks") = py::none(), py::arg("keep_out") = py::none(),
          py::arg("layers") = py::dict(), py::arg("south_west") = Pair(0.0, 0.0), py::arg("crs") = "",
          py::arg("thresholds") = py::dict(), py::arg("allow_unknown") = false, py::arg("threads") = 1)
      .def(
          "patch",
          [](PythonMap& m, const py::object& heights, const Pair& south_west, const py::object& classes,
             const py::object& rocks, const py::object& keep_out) {
            m.patch({heights, classes, rocks, keep_out, {}}, {south_west.first, south_west.second});
          },
          "New ground in a window on the map's cells: NaN, or class 255, leaves a cell as it is.",
          py::arg("heights") = py::none(), py::kw_only(), py::arg("south_west"),
          py::arg("classes") = py::none(), py::arg("rocks") = py::none(), py::arg("keep_out") = py::none())
      .def("learn", &PythonMap::learn, py::arg("telemetry"),
           "Wheel telemetry: the path of a CSV, or a dict of its columns as arrays, whole moments in order "
           "of time, NaN\n"
           "where not measured. Returns how many rows taught something.")
      .def(
          "moved",
          [](const PythonMap& m, int east, int north) {
            return m.moved({east, north});
          },
          py::arg("east"), py::arg("north"),
          "The map of the window that lies so many tiles of 64 cells further east and north.")
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
