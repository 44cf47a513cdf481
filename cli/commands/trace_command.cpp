#include <cmath>

#include <talus/cli/app/command.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/cli/soil/trace_report.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/trace/formula_trace.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/calibration/trace/run_proposal.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

struct TraceCommandOptions {
  std::string telemetry, base, rover, formula, model_out, html, hold_out, runs_out, score;
  int propose = 0;
  double significance = terramech::TraceOptions{}.significance;
  TableOptions columns;
};

void bind(CLI::App& command, TraceCommandOptions& options) {
  addOption(command, "telemetry T.csv", options.telemetry)->required();
  addOption(command, "--base B.yaml", options.base);
  addOption(command, "--formula 'Y = a*X + b*Z'", options.formula);
  addOption(command, "--rover NAME|FILE", options.rover);
  addOption(command, "--significance", options.significance)->check(CLI::Range(1e-3, 0.5));
  auto* hold_out = addOption(command, "--hold-out COLUMN[=VALUES]", options.hold_out);
  auto* propose =
      addOption(command, "--propose N", options.propose)->check(CLI::Range(1, 20))->excludes(hold_out);
  addOption(command, "--score RUNS.csv", options.score)->excludes(hold_out);
  addTableOptions(command, options.columns);
  addOutput(command, "--model-out M.yaml", options.model_out)->excludes(hold_out);
  addOutput(command, "--html R.html", options.html)->excludes(hold_out);
  addOutput(command, "-o,--output RUNS.csv", options.runs_out)->needs(propose);
}

/// Repeats the trace with rows held out and evaluates the rows that the search did not use.
int holdOutRows(const TraceCommandOptions& options, const terramech::Telemetry& table,
                const terramech::TableTraceOptions& how, Context& context) {
  const auto [rows, search] = terramech::traceInput(table, how.base, how.search);
  std::vector<terramech::LeftOutErrors> all;
  for (const terramech::LeftOut& left : terramech::leftOut(rows.trial, options.hold_out, options.telemetry)) {
    const ProgressMonitor watch = context.watch("tracing without " + left.what);
    all.push_back(terramech::traceWithout(rows.model, rows.trial, left, search, watch));
    if (watch.stopped()) return Exit::kCancelled;
  }
  context.answer({{"hold_out", leftOutJson(all)}}, leftOutText(all));
  return Exit::kDone;
}

void writeModel(const std::string& path, const terramech::TableTrace& trace, const Context& context) {
  writeFile(path, trace.modelText());
  const terramech::Soil& soil = trace.result.refined.soil;
  if (soil.c1 + std::abs(soil.c2) > 1.0 || soil.c1 < std::abs(soil.c2))
    context.warn(path +
                 ": its stress peak c1 + c2 slip leaves the contact at slip -1 or 1: predict and assess read "
                 "it, plan and costmap refuse it");
}

/// Scores of the causes that the trace left open, from measured runs.
std::vector<terramech::CauseScore> scored(const TraceCommandOptions& options,
                                          const terramech::TableTrace& trace, const Context& context) {
  const terramech::Telemetry measured =
      terramech::readTraceTable(tableFile(options.score, options.columns, context));
  warnOfRejected(measured.rejected, measured.source, context);
  return terramech::scoreCauses(trace.result, terramech::makeTrial(measured, trace.result.refined));
}

nlohmann::ordered_json formulaJson(const terramech::FormulaTrace& t) {
  const auto of = [&](double value) { return nlohmann::ordered_json{{t.answer, value}}; };
  nlohmann::ordered_json refined;
  for (const auto& [key, p] : t.parameters) refined[key] = {{"value", p.value}, {"std", p.std}};
  const auto linear = [](const std::string& column) -> nlohmann::ordered_json {
    return {{"name", "linear"}, {"covariate", column}};
  };
  const auto causeOf = [&](const terramech::FormulaEffect& e) {
    nlohmann::ordered_json out = linear(e.column);
    out["channel"] = t.answer;
    out["parameters"] = {{"slope", e.slope.value}, {"std", e.slope.std}};
    out["p_value"] = e.p_value;
    out["evidence"] = e.gain;
    out["equal_to"] = jsonList(e.equal, linear);
    return out;
  };
  return {{"verdict", name(t.verdict)},
          {"base", {{"rmse", of(t.base_rmse)}}},
          {"effects", jsonList(t.effects, causeOf)},
          {"rejected", jsonList(t.rejected, causeOf)},
          {"refined", {{"rmse", of(t.refined_rmse)}, {"parameters", refined}}},
          {"held_out",
           {{"scheme", t.scheme},
            {"base_rmse", of(t.base_held)},
            {"refined_rmse", of(t.refined_held)},
            {"noise_floor", of(t.noise_floor)}}}};
}

std::string formulaText(const terramech::FormulaTrace& t) {
  std::string out = fmt::format("{}: {} on held-out {} from {:.4g} to {:.4g} rms, mean {:.4g}\n",
                                name(t.verdict), t.answer, t.scheme, t.base_held, t.refined_held, t.mean);
  for (const terramech::FormulaEffect& e : t.effects)
    out += fmt::format("  {}: {:.4g} +- {:.2g} {} a unit, log-evidence {:.1f}, p {}{}{}\n", e.column,
                       e.slope.value, e.slope.std, t.answer, e.gain, pText(e.p_value),
                       e.equal.empty() ? "" : "; equal: ", fmt::join(e.equal, ", "));
  for (const auto& [key, p] : t.parameters)
    out += fmt::format("  {} = {:.4g} +- {:.2g}\n", key, p.value, p.std);
  return out;
}

int run(const TraceCommandOptions& options, Context& context) {
  if (!options.formula.empty()) {
    for (const std::string& given :
         {options.base, options.rover, options.hold_out, options.score, options.model_out, options.html,
          std::string(static_cast<std::size_t>(options.propose), '+')})
      if (!given.empty())
        throw InputError(
            {"--formula",
             "cannot be combined with --base, --rover, --hold-out, --propose, --score, --model-out or --html",
             "remove them"});
    const auto trace = terramech::traceFormula(
        terramech::readTelemetry(tableFile(options.telemetry, options.columns, context)), options.formula,
        {.significance = options.significance, .seed = context.seed});
    context.answer(formulaJson(trace), formulaText(trace));
    return Exit::kDone;
  }
  const terramech::TableTraceOptions how{
      .base = terramech::baseModel(options.base, options.rover),
      .search = {.significance = options.significance, .seed = context.seed}};
  const terramech::Telemetry table =
      terramech::readTraceTable(tableFile(options.telemetry, options.columns, context));
  warnOfRejected(table.rejected, table.source, context);
  if (!options.hold_out.empty()) return holdOutRows(options, table, how, context);
  const ProgressMonitor watch = context.watch("tracing");
  const terramech::TableTrace trace = terramech::traceTable(table, how, watch);
  if (watch.stopped()) return Exit::kCancelled;
  if (!options.model_out.empty()) writeModel(options.model_out, trace, context);
  if (!options.html.empty()) writeFile(options.html, traceReport(trace, true).html());
  const auto runs = options.propose > 0 ? terramech::proposeRuns(trace.result, options.propose)
                                        : std::vector<terramech::ProposedRun>{};
  if (!options.runs_out.empty() && !runs.empty())
    writeFile(options.runs_out, proposalTable(runs, trace.result));
  const auto scores =
      options.score.empty() ? std::vector<terramech::CauseScore>{} : scored(options, trace, context);
  nlohmann::ordered_json json = traceJson(trace);
  if (options.propose > 0) json["proposals"] = proposalsJson(runs);
  if (!scores.empty()) json["scores"] = scoresJson(scores);
  context.answer(json, traceReport(trace, false).text() +
                           (options.propose > 0 ? proposalText(runs, trace.result.trial) : "") +
                           causeScoreText(scores));
  return trace.applies.applies ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addTrace(CLI::App& app, Context& context) {
  addCommand<TraceCommandOptions>(app, context, "trace", bind, run);
}

}  // namespace talus::cli
