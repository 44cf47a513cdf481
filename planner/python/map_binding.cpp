#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <talus/costmap/map/ground_curves.hpp>
#include <talus/maps/maps.hpp>
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

terramech::Rover roverOf(const py::object& given) {
  if (py::isinstance<terramech::Rover>(given)) return given.cast<terramech::Rover>();
  if (py::isinstance<py::str>(given))
    return py::module_::import("talus._talus").attr("Rover")(given).cast<terramech::Rover>();
  throw py::type_error("rover must be a name or a talus.Rover");
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
  py::array_t<float> out({shape.first, shape.second});
  std::copy(heights.values().begin(), heights.values().end(), out.mutable_data());
  return out;
}

struct Asked {
  std::optional<double> start_heading_rad, goal_heading_rad, max_risk, time_limit_s;
  std::vector<Pair> via;
  double tolerance_m;
  bool prove;
};

PlanRequest requestOf(const Pair& start, const Pair& goal, const Asked& asked) {
  PlanRequest request{.start = {start.first, start.second},
                      .goal = {goal.first, goal.second},
                      .tolerance_m = asked.tolerance_m,
                      .start_heading_rad = asked.start_heading_rad,
                      .goal_heading_rad = asked.goal_heading_rad,
                      .prove = asked.prove};
  for (const auto& [x, y] : asked.via) request.via.push_back({x, y});
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
          "Writes a route that plan() found here, as the GeoJSON of `talus plan`.", py::arg("route"),
          py::arg("path"));
}

// Adds plan().
void addPlan(py::class_<PythonMap>& map) {
  map.def(
      "plan",
      [](PythonMap& m, const Pair& start, const Pair& goal, const std::string& planner, double tolerance_m,
         const std::vector<Pair>& via, std::optional<double> start_heading_rad,
         std::optional<double> goal_heading_rad, std::optional<double> max_risk,
         std::optional<double> time_limit_s, bool prove, std::uint64_t seed, int threads,
         const py::object& progress) {
        PlannerSettings settings{.planner = planner, .seed = seed, .threads = threads};
        if (time_limit_s) settings.time_limit_s = *time_limit_s;
        return m.plan(
            settings,
            requestOf(start, goal,
                      {start_heading_rad, goal_heading_rad, max_risk, time_limit_s, via, tolerance_m, prove}),
            progress);
      },
      "A route over all that is known now; the GIL is released, Ctrl-C ends it. progress: called with 0 "
      "to 1. prove: also the best lower bound and a search over points of cells, which takes longer.",
      py::arg("start"), py::arg("goal"), py::kw_only(), py::arg("planner") = "", py::arg("tolerance_m") = 0.0,
      py::arg("via") = std::vector<Pair>{}, py::arg("start_heading_rad") = py::none(),
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
                      bool allow_unknown, int threads) {
            return std::make_unique<PythonMap>(
                PythonMap::Layers{heights, classes, rocks, keep_out, layers},
                PythonMap::Ground{.rover = roverOf(rover),
                                  .soils = soils,
                                  .policy = {.allow_unknown = allow_unknown},
                                  .resolution_m = resolution_m,
                                  .south_west = {south_west.first, south_west.second},
                                  .threads = threads});
          }),
          "heights: float32 or float64, NaN where not observed. soils: a name or Soil, or a dict of class "
          "numbers to\n"
          "them. layers: joules a metre to add by name; inf is refused, NaN not known.",
          py::arg("heights"), py::kw_only(), py::arg("resolution_m"), py::arg("rover"), py::arg("soils"),
          py::arg("classes") = py::none(), py::arg("rocks") = py::none(), py::arg("keep_out") = py::none(),
          py::arg("layers") = py::dict(), py::arg("south_west") = Pair(0.0, 0.0),
          py::arg("allow_unknown") = false, py::arg("threads") = 1)
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
  addPlan(map);
  bindViews(map);
  addHeights(module);
}

}  // namespace talus::planner
