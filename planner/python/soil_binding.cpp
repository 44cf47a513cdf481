#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <talus/common/common.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using terramech::EstimateOptions;
using terramech::Rover;
using terramech::Soil;
using terramech::SoilEstimate;

struct Asked {
  std::string method, shear_modulus, prior, rover, model;
};

SoilEstimate estimate(const std::filesystem::path& table, const Asked& asked, const py::object& progress) {
  const EstimateOptions options{.table = table.string(),
                                .method = asked.method,
                                .shear_modulus = asked.shear_modulus,
                                .prior = asked.prior,
                                .rover = asked.rover,
                                .model = asked.model};
  SoilEstimate found;
  inBackground([&](const ProgressMonitor& watch) { found = terramech::estimateSoil(options, watch); },
               progress);
  return found;
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
      .def("__repr__", [](const Soil& s) { return "<talus.Soil " + s.name + ">"; });
}

}  // namespace

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
  module.def(
      "estimate",
      [](const std::filesystem::path& table, const std::string& method, const std::string& shear_modulus,
         const std::string& prior, const std::string& rover, const std::string& model,
         const py::object& progress) {
        return estimate(table, {method, shear_modulus, prior, rover, model}, progress);
      },
      "Soil from a telemetry CSV, as `talus estimate`. Ctrl-C ends it.", py::arg("table"), py::kw_only(),
      py::arg("method") = "wong-reece", py::arg("shear_modulus") = "", py::arg("prior") = "",
      py::arg("rover") = "", py::arg("model") = "", py::arg("progress") = py::none());
  module.def("soils", &terramech::librarySoils, "Names of the built-in soils.");
  module.def("rovers", &terramech::libraryRovers, "Names of the built-in rovers.");
}

}  // namespace talus::planner
