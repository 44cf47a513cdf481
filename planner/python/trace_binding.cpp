#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/planner/python/background.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/calibration/verdict/verdict.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using namespace terramech;

struct Asked {
  std::filesystem::path table;
  std::string base, rover;
  double significance = TraceOptions{}.significance;
  std::uint64_t seed = 1;
};

struct Trace {
  TraceResult result;
  Applicability applies;
  std::size_t rows_rejected = 0;
  int beyond_axle = 0;
};

// As `talus trace`.
Trace traced(const Asked& asked, const ProgressMonitor& watch) {
  ModelFile base = asked.base.empty() ? unknownSoil() : loadModel(asked.base);
  if (!asked.rover.empty()) base.model.takeRover(loadRover(asked.rover));
  const Telemetry telemetry = readTelemetry(asked.table, {.required = {"load_N", "slip"}});
  const Trial all = makeTrial(telemetry, base.model);
  std::vector<char> keep = beyondAxle(all);
  for (char& row : keep) row = !row;
  const Trial trial = subset(all, keep);
  if (trial.rows() < 6)
    throw InputError({asked.table.string(),
                      std::to_string(trial.rows()) +
                          " usable rows with sinkage below the wheel radius; tracing needs at least 6",
                      ""});
  base.model.slip_along_travel |= slipIsAlongTravel(trial.states);
  if (base.soil_given && trial.moment.empty()) giveDefaultDeviations(base.model);
  TraceOptions how{.significance = asked.significance};
  how.fit_soil = !base.soil_given;
  how.seed = asked.seed;
  Trace trace{.result = traceResiduals(base.model, trial, how, watch)};
  if (watch.stopped()) return trace;
  trace.applies = applicability(trace.result, how);
  trace.rows_rejected = telemetry.rejected.size();
  trace.beyond_axle = all.rows() - trial.rows();
  return trace;
}

Trace trace(const Asked& asked, const py::object& progress) {
  if (!(asked.significance >= 1e-3 && asked.significance <= 0.5))
    throw py::value_error("significance = " + std::to_string(asked.significance) + ", must be 0.001 to 0.5");
  Trace found;
  inBackground([&](const ProgressMonitor& watch) { found = traced(asked, watch); }, progress);
  return found;
}

// By the names of channels that are measured.
py::dict byChannel(const ChannelErrors& errors) {
  py::dict out;
  for (const Channel c : {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque, Channel::SideForce})
    if (const double error = errors[static_cast<std::size_t>(c)]; std::isfinite(error)) out[name(c)] = error;
  return out;
}

const Effect& formOf(const TracedEffect& effect) {
  return effect.chosen.candidate.parts.front();
}

// Of a known form by name; of a curve none.
py::dict parametersOf(const TracedEffect& effect) {
  py::dict out;
  const Effect& part = formOf(effect);
  if (const EffectForm* form = findEffect(part.name))
    for (std::size_t k = 0; k < part.parameters.size(); ++k)
      out[form->parameters[k].name] = part.parameters[k];
  return out;
}

py::tuple curveOf(const TracedEffect& effect) {
  const Effect& part = formOf(effect);
  if (!part.empirical()) return py::make_tuple(std::vector<double>{}, std::vector<double>{});
  return py::make_tuple(part.knots, part.parameters);
}

std::vector<std::string> alternativesOf(const TracedEffect& effect) {
  std::vector<std::string> names;
  for (const Explanation& e : effect.alternatives) names.push_back(e.candidate.parts.front().name);
  return names;
}

void bindEffect(py::module_& module) {
  py::class_<TracedEffect>(module, "TracedEffect", "An effect that residuals show and the base model lacks.")
      .def_property_readonly("name", [](const TracedEffect& e) { return formOf(e).name; })
      .def_property_readonly(
          "covariate",
          [](const TracedEffect& e) {
            return formOf(e).only_column.empty() ? formOf(e).covariate : formOf(e).only_column;
          },
          "the column that explains it")
      .def_property_readonly(
          "channel", [](const TracedEffect& e) { return std::string(name(e.channel)); },
          "where it shows most")
      .def_property_readonly("parameters", &parametersOf, "of a known form, by name; SI units")
      .def_property_readonly("curve", &curveOf, "(knots, values) where it matches no known form")
      .def_property_readonly("formula",
                             [](const TracedEffect& e) {
                               const EffectForm* form = findEffect(formOf(e).name);
                               return std::string(form ? form->formula : "");
                             })
      .def_readonly("p_value", &TracedEffect::p_value)
      .def_property_readonly("log_likelihood_gain",
                             [](const TracedEffect& e) { return 0.5 * e.chosen.chi2_gain; })
      .def_property_readonly("alternatives", &alternativesOf,
                             "names of others that explain it about as well");
}

void bindErrors(py::class_<Trace>& trace) {
  trace.def_property_readonly("base_rmse", [](const Trace& t) { return byChannel(t.result.base_rmse); })
      .def_property_readonly("refined_rmse", [](const Trace& t) { return byChannel(t.result.refined_rmse); })
      .def_property_readonly("noise_floor", [](const Trace& t) { return byChannel(t.result.noise_floor); })
      .def_property_readonly(
          "held_out_scheme", [](const Trace& t) { return t.result.held_out.scheme; },
          "what was held out together")
      .def_property_readonly("held_out_base_rmse",
                             [](const Trace& t) { return byChannel(t.result.held_out.base_rmse); })
      .def_property_readonly("held_out_refined_rmse",
                             [](const Trace& t) { return byChannel(t.result.held_out.refined_rmse); });
}

}  // namespace

void bindTrace(py::module_& module) {
  bindEffect(module);
  py::class_<Trace> trace_class(
      module, "Trace",
      "What a wheel model lacks. Errors are root mean squares by channel, as shares of load, of load times\n"
      "radius (torque) or of radius (sinkage).");
  trace_class
      .def_property_readonly(
          "verdict", [](const Trace& t) { return std::string(name(answerOf(t.result).verdict)); },
          "explained, nothing_missing or unexplained")
      .def_property_readonly("effects", [](const Trace& t) { return t.result.effects; })
      .def_property_readonly(
          "applies", [](const Trace& t) { return t.applies.applies; },
          "whether a rigid wheel on soil, with physical effects, describes the rows")
      .def_property_readonly("applies_reason", [](const Trace& t) { return t.applies.reason; })
      .def_property_readonly("rows_used", [](const Trace& t) { return t.result.trial.rows(); })
      .def_readonly("rows_rejected", &Trace::rows_rejected)
      .def_readonly("beyond_axle", &Trace::beyond_axle, "rows left out because the wheel is sunk to its axle")
      .def(
          "model_text", [](const Trace& t) { return modelText(forPrediction(t.result), t.result.scope); },
          "The refined model as a YAML file has it, for base= and `talus predict --model`.")
      .def("__repr__", [](const Trace& t) {
        return "<talus.Trace " + std::string(name(answerOf(t.result).verdict)) + ", " +
               std::to_string(t.result.effects.size()) + " effects>";
      });
  bindErrors(trace_class);
  module.def(
      "trace",
      [](const std::filesystem::path& table, const std::string& base, const std::string& rover,
         double significance, std::uint64_t seed, const py::object& progress) {
        return trace({table, base, rover, significance, seed}, progress);
      },
      "Effects that a wheel model lacks, from a telemetry CSV, as `talus trace`. base: a soil or model "
      "file,\n"
      "without it a soil is fitted; rover: supplies wheel dimensions missing from the file. The GIL is\n"
      "released, Ctrl-C ends it. progress: called with 0 to 1.",
      py::arg("table"), py::kw_only(), py::arg("base") = "", py::arg("rover") = "",
      py::arg("significance") = TraceOptions{}.significance, py::arg("seed") = 1,
      py::arg("progress") = py::none());
}

}  // namespace talus::planner
