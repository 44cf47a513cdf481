#include <cstddef>
#include <utility>

#include <pybind11/stl.h>

#include <talus/planner/planner.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/planner/route/route_json.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

const Route& routeOf(const py::object& self) {
  return self.cast<const Route&>();
}

// View of one member of all vertices, with the size of a vertex as stride.
py::array column(const py::object& self, const std::string& name) {
  const auto& vertices = routeOf(self).vertices;
  for (const auto& [known, field] : kVertexColumns)
    if (name == known)
      return viewOf(vertices.empty() ? nullptr : &(vertices.front().*field),
                    {static_cast<py::ssize_t>(vertices.size())},
                    {static_cast<py::ssize_t>(sizeof(RouteVertex))}, self);
  throw py::key_error("a route has no column '" + name + "'; Route.COLUMNS lists them");
}

std::vector<std::string> columnNames() {
  std::vector<std::string> names;
  for (const auto& [name, field] : kVertexColumns) names.emplace_back(name);
  return names;
}

}  // namespace

void bindRoute(py::module_& module) {
  py::class_<Route> route(module, "Route",
                          "A route, or why there is none. route['x_m'] is a column, one value a vertex.");
  route
      .def_property_readonly(
          "status", [](const Route& r) { return std::string(name(r.status)); },
          "found, no_route, none_found, start_invalid, goal_invalid, timed_out or cancelled")
      .def_readonly("reason", &Route::reason)
      .def_property_readonly("found", [](const Route& r) { return r.status == RouteStatus::Found; })
      .def_property_readonly("cost_J", [](const Route& r) { return r.cost; })
      .def_property_readonly("lower_bound_J", [](const Route& r) { return r.lower_bound; })
      .def_property_readonly("energy_J", [](const Route& r) { return r.energy_J; })
      .def_property_readonly("time_s", [](const Route& r) { return r.time_s; })
      .def_property_readonly("energy_p90_J", [](const Route& r) { return r.energy_p90_J; })
      .def_property_readonly("time_p90_s", [](const Route& r) { return r.time_p90_s; })
      .def_property_readonly("length_m", [](const Route& r) { return r.length_m; })
      .def_property_readonly("max_slip", [](const Route& r) { return r.max_slip; })
      .def_property_readonly("max_slope_rad", [](const Route& r) { return r.max_slope_rad; })
      .def_property_readonly("gap", [](const Route& r) { return r.gap; })
      .def_property_readonly("planner", [](const Route& r) { return r.planner; })
      .def_property_readonly(
          "immobilisation_risk",
          [](const Route& r) { return r.vertices.empty() ? 0.0 : r.vertices.back().immobilisation_risk; })
      .def("__len__", [](const Route& r) { return r.vertices.size(); })
      .def("__getitem__", &column, py::arg("column"), "A column, read-only, without a copy.")
      .def("__repr__", [](const Route& r) {
        return "<talus.Route " + std::string(name(r.status)) + ", " + std::to_string(r.vertices.size()) +
               " vertices>";
      });
  py::class_<Score, Route>(module, "Score",
                           "What a polyline costs: a route, and where and why it may not be driven.")
      .def_property_readonly(
          "status", [](const Score& s) { return std::string(s.violations.empty() ? "found" : "infeasible"); },
          "found, or infeasible: its cost is then infinite")
      .def_property_readonly(
          "violations",
          [](const Score& s) {
            std::vector<std::tuple<double, double, std::string>> all;
            for (const Violation& v : s.violations) all.emplace_back(v.place.x_m, v.place.y_m, v.reason);
            return all;
          },
          "(x_m, y_m, reason) each")
      .def_readonly("best", &Score::best, "With prove: the best route between the ends, else None.");
  py::list categories;
  for (const auto category : {terramech::Category::Safe, terramech::Category::Marginal,
                              terramech::Category::Dangerous, terramech::Category::Unknown})
    categories.append(py::make_tuple(terramech::name(category), categoryColour(category)));
  module.attr("_CATEGORIES") = py::tuple(categories);
  route.attr("COLUMNS") = py::tuple(py::cast(columnNames()));
}

}  // namespace talus::planner
