#include <cmath>
#include <optional>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <talus/common/common.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using terramech::EstimateOptions;
using terramech::Rover;
using terramech::Soil;
using terramech::SoilEstimate;

SoilEstimate estimate(const py::object& table, const std::string& method, const std::string& shear_modulus,
                      const std::string& prior, const std::string& rover, const std::string& model,
                      const py::object& progress) {
  SoilEstimate found;
  withTable(table, [&](const std::string& path, const std::string&) {
    const EstimateOptions options{.table = path,
                                  .method = method,
                                  .shear_modulus = shear_modulus,
                                  .prior = prior,
                                  .rover = rover,
                                  .model = model};
    inBackground([&](const ProgressMonitor& watch) { found = terramech::estimateSoil(options, watch); },
                 progress);
  });
  return found;
}

py::dict wheel(const py::object& soil, const py::object& given, double slip, std::optional<double> load_N,
               double slip_angle_rad) {
  if (!(std::abs(slip) <= 1.0)) throw py::value_error("slip = " + std::to_string(slip) + ", must be -1 to 1");
  const Rover rover = roverOf(given);
  const terramech::WheelForces forces =
      terramech::equilibrium(terramech::underGravity(soilOf(soil), rover.gravity_m_s2), rover.wheel,
                             {.load_N = load_N ? *load_N : terramech::wheelLoad_N(rover),
                              .slip = slip,
                              .slip_angle_rad = slip_angle_rad,
                              .gravity_m_s2 = rover.gravity_m_s2});
  py::dict out;
  out["sinkage_m"] = forces.sinkage_m;
  out["entry_angle_rad"] = forces.entry_angle_rad;
  out["torque_Nm"] = forces.torque_Nm;
  out["drawbar_pull_N"] = forces.drawbar_pull_N;
  out["side_force_N"] = forces.side_force_N;
  return out;
}

void bindParts(py::module_& module) {
  py::class_<Rover>(module, "Rover", "A rover of the library by name, or of a YAML file. SI units.")
      .def(py::init([](const std::string& name) { return terramech::loadRover(name); }), py::arg("name"))
      .def_readwrite("name", &Rover::name)
      .def_readwrite("mass_kg", &Rover::mass_kg)
      .def_readwrite("gravity_m_s2", &Rover::gravity_m_s2)
      .def_readwrite("wheel_count", &Rover::wheel_count)
      .def_property(
          "wheel_radius_m", [](const Rover& r) { return r.wheel.radius_m; },
          [](Rover& r, double value) { r.wheel.radius_m = value; })
      .def_property(
          "wheel_width_m", [](const Rover& r) { return r.wheel.width_m; },
          [](Rover& r, double value) { r.wheel.width_m = value; })
      .def_property(
          "grouser_height_m", [](const Rover& r) { return r.wheel.grouser_height_m; },
          [](Rover& r, double value) { r.wheel.grouser_height_m = value; })
      .def_property(
          "grouser_count", [](const Rover& r) { return r.wheel.grouser_count; },
          [](Rover& r, int value) { r.wheel.grouser_count = value; })
      .def_readwrite("wheelbase_m", &Rover::wheelbase_m)
      .def_readwrite("track_m", &Rover::track_m)
      .def_readwrite("clearance_m", &Rover::clearance_m)
      .def_readwrite("centre_of_mass_height_m", &Rover::centre_of_mass_height_m)
      .def_readwrite("max_pitch_rad", &Rover::max_pitch_rad)
      .def_readwrite("max_roll_rad", &Rover::max_roll_rad)
      .def_readwrite("max_torque_Nm", &Rover::max_torque_Nm)
      .def_readwrite("max_speed_mps", &Rover::max_speed_mps)
      .def_readwrite("turning_radius_m", &Rover::turning_radius_m)
      .def_readwrite("hotel_power_W", &Rover::hotel_power_W)
      .def("__repr__", [](const Rover& r) { return "<talus.Rover " + r.name + ">"; });
  py::class_<Soil>(module, "Soil", "Mean soil of the library by name, or of a YAML file. SI units.")
      .def(py::init([](const std::string& name) { return terramech::loadSoil(name); }), py::arg("name"))
      .def_readwrite("name", &Soil::name)
      .def_readwrite("cohesion_Pa", &Soil::cohesion_Pa)
      .def_readwrite("friction_angle_rad", &Soil::friction_angle_rad)
      .def_readwrite("sinkage_exponent", &Soil::sinkage_exponent)
      .def_readwrite("cohesive_modulus", &Soil::cohesive_modulus)
      .def_readwrite("frictional_modulus", &Soil::frictional_modulus)
      .def_readwrite("shear_modulus_m", &Soil::shear_modulus_m)
      .def_readwrite("c1", &Soil::c1)
      .def_readwrite("c2", &Soil::c2)
      .def_readwrite("density_kg_m3", &Soil::density_kg_m3)
      .def("__repr__", [](const Soil& s) { return "<talus.Soil " + s.name + ">"; });
}

}  // namespace

Rover roverOf(const py::handle& given) {
  if (py::isinstance<Rover>(given)) return given.cast<Rover>();
  if (py::isinstance<py::str>(given)) return terramech::loadRover(given.cast<std::string>());
  throw py::type_error("rover must be a name or a talus.Rover");
}

Soil soilOf(const py::handle& given) {
  if (py::isinstance<Soil>(given)) return given.cast<Soil>();
  if (py::isinstance<py::str>(given)) return terramech::loadSoil(given.cast<std::string>());
  throw py::type_error("soil must be a name or a talus.Soil");
}

void bindSoil(py::module_& module) {
  bindParts(module);
  py::class_<SoilEstimate>(module, "SoilEstimate",
                           "Soil from telemetry; NaN where the method gives no number.")
      .def_readonly("cohesion_Pa", &SoilEstimate::cohesion_Pa)
      .def_readonly("friction_angle_rad", &SoilEstimate::friction_angle_rad)
      .def_readonly("shear_modulus_m", &SoilEstimate::shear_modulus_m)
      .def_readonly("sinkage_exponent", &SoilEstimate::sinkage_exponent)
      .def_readonly("covariance", &SoilEstimate::covariance, "of (c, tan phi)")
      .def_readonly("rows_used", &SoilEstimate::rows_used)
      .def_property_readonly("rows_rejected", [](const SoilEstimate& e) { return e.rejected.size(); })
      .def_readonly("warnings", &SoilEstimate::warnings);
  module.def("estimate", &estimate, py::arg("table"), py::kw_only(), py::arg("method") = "wong-reece",
             py::arg("shear_modulus") = "", py::arg("prior") = "", py::arg("rover") = "",
             py::arg("model") = "", py::arg("progress") = py::none(),
             "Soil from a telemetry CSV or a dict of its columns, as `talus estimate`. Ctrl-C ends it.");
  module.def("wheel", &wheel, py::arg("soil"), py::arg("rover"), py::kw_only(), py::arg("slip"),
             py::arg("load_N") = py::none(), py::arg("slip_angle_rad") = 0.0,
             R"(Sinkage, entry angle, torque, drawbar pull and side force of a wheel, as `talus wheel`.
load_N: that of the rover on level ground where it is None.)");
  module.def("soils", &terramech::librarySoils, "Names of the built-in soils.");
  module.def("rovers", &terramech::libraryRovers, "Names of the built-in rovers.");
}

}  // namespace talus::planner
