#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <talus/common/common.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/bindings.hpp>
#include <talus/terramech/calibration.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

using namespace terramech;

TableTrace trace(const py::object& table, const std::string& base, const std::string& rover,
                 double significance, std::uint64_t seed, const py::object& progress) {
  if (!(significance >= 1e-3 && significance <= 0.5))
    throw py::value_error("significance = " + std::to_string(significance) + ", must be 0.001 to 0.5");
  TableTrace found;
  withTable(table, [&](const std::string& path, const std::string& name) {
    inBackground(
        [&](const ProgressMonitor& watch) {
          const TableTraceOptions how{.base = baseModel(base, rover),
                                      .search = {.significance = significance, .seed = seed}};
          Telemetry rows = readTraceTable(path);
          rows.source = name;
          found = traceTable(rows, how, watch);
        },
        progress);
  });
  return found;
}

// Errors of the measured channels, by channel name.
py::dict byChannel(const ChannelErrors& errors) {
  py::dict out;
  for (const Channel c : {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque, Channel::SideForce})
    if (const double error = errors[static_cast<std::size_t>(c)]; std::isfinite(error)) out[name(c)] = error;
  return out;
}

const Effect& formOf(const TracedEffect& effect) {
  return effect.chosen.candidate.parts.front();
}

// Parameters of a known form, by name; empty for an empirical curve.
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
  for (const Explanation& e : effect.equal) names.push_back(e.candidate.parts.front().name);
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

void bindErrors(py::class_<TableTrace>& trace) {
  trace.def_property_readonly("base_rmse", [](const TableTrace& t) { return byChannel(t.result.base_rmse); })
      .def_property_readonly("refined_rmse",
                             [](const TableTrace& t) { return byChannel(t.result.refined_rmse); })
      .def_property_readonly("noise_floor",
                             [](const TableTrace& t) { return byChannel(t.result.noise_floor); })
      .def_property_readonly(
          "held_out_scheme", [](const TableTrace& t) { return t.result.held_out.scheme; },
          "what was held out together")
      .def_property_readonly("held_out_base_rmse",
                             [](const TableTrace& t) { return byChannel(t.result.held_out.base_rmse); })
      .def_property_readonly("held_out_refined_rmse",
                             [](const TableTrace& t) { return byChannel(t.result.held_out.refined_rmse); });
}

}  // namespace

void bindTrace(py::module_& module) {
  bindEffect(module);
  py::class_<TableTrace> trace_class(
      module, "Trace",
      R"(What a wheel model lacks. Errors are root mean squares by channel, as shares of load, of load times radius
(torque) or of radius (sinkage).)");
  trace_class
      .def_property_readonly(
          "verdict", [](const TableTrace& t) { return std::string(name(t.answer.verdict)); },
          "explained, nothing_missing or unexplained")
      .def_property_readonly("effects", [](const TableTrace& t) { return t.result.effects; })
      .def_property_readonly(
          "applies", [](const TableTrace& t) { return t.applies.applies; },
          "whether a rigid wheel on soil, with physical effects, describes the rows")
      .def_property_readonly("applies_reason", [](const TableTrace& t) { return t.applies.reason; })
      .def_property_readonly("rows_used", [](const TableTrace& t) { return t.rowsUsed(); })
      .def_property_readonly("rows_rejected", [](const TableTrace& t) { return t.rejected.size(); })
      .def_readonly("beyond_axle", &TableTrace::beyond_axle,
                    "rows left out because the wheel is sunk to its axle")
      .def("model_text", &TableTrace::modelText,
           "The refined model as a YAML file has it, for base= and `talus predict --model`.")
      .def("__repr__", [](const TableTrace& t) {
        return "<talus.Trace " + std::string(name(t.answer.verdict)) + ", " +
               std::to_string(t.result.effects.size()) + " effects>";
      });
  bindErrors(trace_class);
  module.def(
      "trace", &trace, py::arg("table"), py::kw_only(), py::arg("base") = "", py::arg("rover") = "",
      py::arg("significance") = TraceOptions{}.significance, py::arg("seed") = 1,
      py::arg("progress") = py::none(),
      R"(Effects that a wheel model lacks, from a telemetry CSV or a dict of its columns, as `talus trace`.
base: a soil or model file, without it a soil is fitted; rover: supplies wheel dimensions missing from the file.
The GIL is released, Ctrl-C ends it. progress: called with 0 to 1.)");
}

}  // namespace talus::planner
