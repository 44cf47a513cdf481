#include <cstddef>
#include <utility>

#include <pybind11/stl.h>

#include <talus/common/common.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/planner/python/python_map.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using Pair = std::pair<double, double>;

SoilKnowledge beliefOf(const std::string& word) {
  std::string all;
  for (const SoilKnowledge belief : {SoilKnowledge::Geometry, SoilKnowledge::Prior, SoilKnowledge::OnLine,
                                     SoilKnowledge::PerfectKnowledge}) {
    if (name(belief) == word) return belief;
    all += (all.empty() ? "" : ", ") + std::string(name(belief));
  }
  throw py::value_error("belief '" + word + "' must be one of " + all);
}

Truth truthOf(const py::dict& soils,
              const std::vector<std::tuple<double, double, double, py::object>>& patches) {
  Truth truth;
  for (const auto& [number, soil] : soils) truth.classes.emplace(number.cast<int>(), soilOf(soil));
  for (const auto& [x, y, radius_m, soil] : patches)
    truth.patches.push_back({{x, y}, radius_m, soilOf(soil)});
  return truth;
}

TraverseSimulation simulate(const PythonMap& map, const SimulationSite::Parts& parts, SoilKnowledge belief,
                            const py::object& progress) {
  TraverseSimulation drive;
  inBackground(
      [&](const ProgressMonitor& watch) {
        drive = SimulationSite(map.map(), parts).world(belief, 0, watch).drive;
      },
      progress);
  return drive;
}

py::array track(const py::object& self, const double& first) {
  const auto& points = self.cast<const TraverseSimulation&>().track;
  return viewOf(points.empty() ? nullptr : &first, {static_cast<py::ssize_t>(points.size())},
                {static_cast<py::ssize_t>(sizeof(TrackPoint))}, self);
}

template <typename Value>
auto column(const Value& value) {
  return [value](const py::object& self) {
    static const TrackPoint none;
    const auto& points = self.cast<const TraverseSimulation&>().track;
    return track(self, value(points.empty() ? none : points.front()));
  };
}

}  // namespace

void bindSimulation(py::module_& module) {
  py::class_<TraverseSimulation>(module, "Simulation",
                                 "A simulated drive; its track as columns without a copy.")
      .def_property_readonly(
          "outcome", [](const TraverseSimulation& s) { return std::string(name(s.outcome)); },
          "reached, immobilised, tipped, gave_up or slid")
      .def_readonly("cause", &TraverseSimulation::cause)
      .def_readonly("energy_J", &TraverseSimulation::energy_J)
      .def_readonly("length_m", &TraverseSimulation::length_m)
      .def_readonly("max_slip", &TraverseSimulation::max_slip)
      .def_readonly("replans", &TraverseSimulation::replans)
      .def_readonly("alarms", &TraverseSimulation::alarms)
      .def_property_readonly("x_m", column([](const TrackPoint& p) -> const double& { return p.place.x_m; }))
      .def_property_readonly("y_m", column([](const TrackPoint& p) -> const double& { return p.place.y_m; }))
      .def_property_readonly("time_s", column([](const TrackPoint& p) -> const double& { return p.time_s; }))
      .def_property_readonly("slip", column([](const TrackPoint& p) -> const double& { return p.slip; }))
      .def_property_readonly("sinkage_m",
                             column([](const TrackPoint& p) -> const double& { return p.sinkage_m; }));
  module.def(
      "simulate",
      [](const PythonMap& map, const Pair& start, const Pair& goal, const py::dict& true_soils,
         const std::vector<std::tuple<double, double, double, py::object>>& patches,
         const std::string& belief, std::uint64_t seed, const py::object& progress) {
        return simulate(map,
                        {.truth = truthOf(true_soils, patches),
                         .start = {start.first, start.second},
                         .goal = {goal.first, goal.second},
                         .firm = terramech::loadSoil("bedrock"),
                         .seed = seed},
                        beliefOf(belief), progress);
      },
      R"(Drives over true soils that the map does not know; true_soils: class number to soil where it differs,
patches: (x_m, y_m, radius_m, soil). The map itself learns nothing.)",
      py::arg("map"), py::arg("start"), py::arg("goal"), py::kw_only(), py::arg("true_soils") = py::dict(),
      py::arg("patches") = std::vector<std::tuple<double, double, double, py::object>>{},
      py::arg("belief") = "online", py::arg("seed") = 1, py::arg("progress") = py::none());
}

}  // namespace talus::planner
