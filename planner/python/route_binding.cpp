#include <array>
#include <cstddef>
#include <utility>

#include <pybind11/stl.h>

#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/planner/route/route.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

constexpr std::pair<const char*, double RouteVertex::*> kColumns[] = {
    {"x_m", &RouteVertex::x_m},
    {"y_m", &RouteVertex::y_m},
    {"elevation_m", &RouteVertex::elevation_m},
    {"heading_rad", &RouteVertex::heading_rad},
    {"slope_along_rad", &RouteVertex::slope_along_rad},
    {"slope_across_rad", &RouteVertex::slope_across_rad},
    {"slip", &RouteVertex::slip},
    {"slip_angle_rad", &RouteVertex::slip_angle_rad},
    {"side_force_over_load", &RouteVertex::side_force_over_load},
    {"stability_margin_rad", &RouteVertex::stability_margin_rad},
    {"sinkage_m", &RouteVertex::sinkage_m},
    {"torque_Nm", &RouteVertex::torque_Nm},
    {"drawbar_pull_margin", &RouteVertex::drawbar_pull_margin},
    {"energy_J", &RouteVertex::energy_J},
    {"time_s", &RouteVertex::time_s},
    {"immobilisation_risk", &RouteVertex::immobilisation_risk},
};

const Route& routeOf(const py::object& self) {
  return self.cast<const Route&>();
}

// View of one member of all vertices, with the size of a vertex as stride.
py::array column(const py::object& self, const std::string& name) {
  const auto& vertices = routeOf(self).vertices;
  for (const auto& [known, field] : kColumns)
    if (name == known)
      return viewOf(vertices.empty() ? nullptr : &(vertices.front().*field),
                    {static_cast<py::ssize_t>(vertices.size())},
                    {static_cast<py::ssize_t>(sizeof(RouteVertex))}, self);
  throw py::key_error("a route has no column '" + name + "'; Route.COLUMNS lists them");
}

std::vector<std::string> columnNames() {
  std::vector<std::string> names;
  for (const auto& [name, field] : kColumns) names.emplace_back(name);
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
  route.attr("COLUMNS") = py::tuple(py::cast(columnNames()));
}

}  // namespace talus::planner
