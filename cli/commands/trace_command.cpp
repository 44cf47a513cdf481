#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/soil/left_out_report.hpp>
#include <talus/cli/soil/trace_report.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::cli {
namespace {

struct TraceCommandOptions {
  std::string telemetry, base, rover, model_out, html, hold_out;
  double significance = terramech::TraceOptions{}.significance;
};

void bind(CLI::App& command, TraceCommandOptions& options) {
  command.add_option("telemetry", options.telemetry, "measured wheel telemetry")
      ->required()
      ->type_name("T.csv");
  command.add_option("--base", options.base, "base soil or model (default: a soil fitted to the data)")
      ->type_name("B.yaml");
  command.add_option("--rover", options.rover, "rover that supplies wheel dimensions missing from the file")
      ->type_name("NAME|FILE");
  command
      .add_option("--significance", options.significance,
                  "share of tables without an effect in which one may be found")
      ->check(CLI::Range(1e-3, 0.5))
      ->capture_default_str();
  auto* hold_out =
      command
          .add_option(
              "--hold-out", options.hold_out,
              "trace without these rows, then predict them: each level of a column in turn, or its values "
              "V,V or LOW..HIGH; a value that holds a comma in double quotes")
          ->type_name("COLUMN[=VALUES]");
  groupOptions(command, "Analysis");
  addOutput(command, "--model-out", options.model_out, "refined model to write")
      ->excludes(hold_out)
      ->type_name("M.yaml");
  addOutput(command, "--html", options.html, "page to write, with charts")->type_name("R.html");
  groupOptions(command, "Output");
}

terramech::ModelFile baseOf(const TraceCommandOptions& options) {
  terramech::ModelFile file;
  if (!options.base.empty()) file = terramech::loadModel(options.base);
  if (options.base.empty()) file = terramech::unknownSoil();
  if (!options.rover.empty()) file.model.takeRover(terramech::loadRover(options.rover));
  return file;
}

void warnOfRejected(const terramech::Telemetry& telemetry, const Context& context) {
  constexpr std::size_t kShown = 20;
  for (std::size_t k = 0; k < telemetry.rejected.size() && k < kShown; ++k)
    context.warn(
        fmt::format("{}:{}: {}", telemetry.source, telemetry.rejected[k].line, telemetry.rejected[k].reason));
  if (telemetry.rejected.size() > kShown)
    context.warn(
        fmt::format("{}: {} more rows rejected", telemetry.source, telemetry.rejected.size() - kShown));
}

std::vector<char> without(std::vector<char> rows) {
  for (char& row : rows) row = !row;
  return rows;
}

/// The loop on rows that the search never saw.
int holdOutRows(const TraceCommandOptions& options, const terramech::RefinedModel& base,
                const terramech::Trial& trial, const terramech::TraceOptions& how, Context& context) {
  std::vector<terramech::LeftOutErrors> all;
  for (const terramech::LeftOut& left : terramech::leftOut(trial, options.hold_out, options.telemetry)) {
    const ProgressMonitor watch = context.watch("tracing without " + left.what);
    all.push_back(terramech::traceWithout(base, trial, left, how, watch));
    if (watch.stopped()) return Exit::kCancelled;
  }
  if (!options.html.empty()) writeFile(options.html, leftOutPage(all, options.hold_out, options.telemetry));
  if (context.json)
    printJson({{"hold_out", leftOutJson(all)}});
  else
    print(leftOutText(all));
  return Exit::kDone;
}

int run(const TraceCommandOptions& options, Context& context) {
  terramech::ModelFile base = baseOf(options);
  terramech::Telemetry telemetry =
      terramech::readTelemetry(options.telemetry, {.required = {"load_N", "slip"}});
  terramech::leaveOutWithoutSlipAngle(telemetry);
  warnOfRejected(telemetry, context);
  const terramech::Trial all = terramech::makeTrial(telemetry, base.model);
  const std::vector<char> sunk = terramech::beyondAxle(all);
  const terramech::Trial trial = terramech::subset(all, without(sunk));
  if (trial.rows() < 6)
    throw InputError(
        {options.telemetry,
         fmt::format("{} usable rows with sinkage below the wheel radius; tracing needs at least 6",
                     trial.rows()),
         ""});
  base.model.slip_along_travel |= terramech::slipIsAlongTravel(trial.states);
  // A drive has not the information for soil and effects at once.
  if (base.soil_given && trial.moment.empty()) terramech::giveDefaultDeviations(base.model);
  terramech::TraceOptions how{.significance = options.significance};
  how.fit_soil = !base.soil_given;
  how.seed = context.seed;
  if (!options.hold_out.empty()) return holdOutRows(options, base.model, trial, how, context);
  const ProgressMonitor watch = context.watch("tracing");
  TraceStory story{options.telemetry,
                   telemetry.rejected.size(),
                   terramech::traceResiduals(base.model, trial, how, watch),
                   {},
                   {}};
  if (watch.stopped()) return Exit::kCancelled;
  story.held_out = terramech::holdOutLevels(story.result, how);
  story.held_out.insert(story.held_out.begin(), story.result.held_out);
  story.beyond_axle = all.rows() - trial.rows();
  if (story.beyond_axle > 0)
    story.beyond_axle_rmse = terramech::rmseOf(story.result.refined, terramech::subset(all, sunk));
  story.applies = terramech::applicability(story.result, how);
  if (!options.model_out.empty()) {
    const terramech::RefinedModel model = terramech::forPrediction(story.result);
    writeFile(options.model_out, terramech::modelText(model, story.result.scope));
    if (model.soil.c1 + std::abs(model.soil.c2) > 1.0 || model.soil.c1 < std::abs(model.soil.c2))
      context.warn(
          options.model_out +
          ": its stress peak c1 + c2 slip leaves the contact at slip -1 or 1: predict and assess read "
          "it, plan and costmap refuse it");
  }
  if (!options.html.empty()) writeFile(options.html, tracePage(story));
  if (context.json)
    printJson(traceJson(story));
  else
    print(traceText(story));
  return story.applies.applies ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addTrace(CLI::App& app, Context& context) {
  addCommand<TraceCommandOptions>(
      app, context,
      {.name = "trace",
       .group = Group::kSoil,
       .description = "find effects missing from a wheel model; write the refined model",
       .examples = "  talus trace drive.csv --base soil.yaml --model-out refined.yaml --html residuals.html\n"
                   "  talus trace drive.csv --json\n"
                   "  talus trace runs.csv --hold-out slip=0.5..1\n"},
      bind, run);
}

}  // namespace talus::cli
