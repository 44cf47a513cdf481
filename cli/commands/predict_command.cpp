#include <talus/cli/app/command.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/terramech/calibration/table/prediction_table.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

struct PredictOptions {
  std::string table, model, rover, output;
  TableOptions columns;
};

void bind(CLI::App& command, PredictOptions& options) {
  addOption(command, "telemetry T.csv", options.table)->required();
  addOption(command, "--model M.yaml", options.model)->required();
  addOption(command, "--rover NAME|FILE", options.rover);
  addTableOptions(command, options.columns);
  addOutput(command, "-o,--output OUT.csv", options.output)->required();
}

int run(const PredictOptions& options, Context& context) {
  terramech::ModelFile file = terramech::loadModel(options.model);
  if (!file.soil_given)
    throw InputError({options.model, "defines no soil", "fit one first: talus trace --model-out"});
  if (!options.rover.empty()) file.model.takeRover(terramech::loadRover(options.rover));
  const auto table = terramech::predictTable(tableFile(options.table, options.columns, context), file.model,
                                             file.scope, context.watch("predicting"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  if (table.predicted == 0)
    throw InputError(
        {options.table, "none of its rows can be predicted",
         table.refused.empty() ? "it has no rows" : "first reason: " + table.refused.front().reason});
  warnOfRejected(table.refused, options.table, context);
  if (table.replaced) context.warn(options.table + ": contains prediction columns; they are replaced");
  if (table.outside > 0)
    context.warn(fmt::format(
        "{}: {} rows lie outside the range that the model was fitted to (predicted_outside); their "
        "standard deviations grow with the distance",
        options.table, table.outside));
  writeFile(options.output, table.text);
  context.answer({{"rows_predicted", table.predicted},
                  {"rows_outside", table.outside},
                  {"rows_refused", table.refused.size()},
                  {"refused", rejectedJson(table.refused)}},
                 fmt::format("{}: {} rows predicted, {} refused\n", options.output, table.predicted,
                             table.refused.size()));
  return Exit::kDone;
}

}  // namespace

void addPredict(CLI::App& app, Context& context) {
  addCommand<PredictOptions>(app, context, "predict", bind, run);
}

}  // namespace talus::cli
