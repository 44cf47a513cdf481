#include <cmath>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/tables/method_estimates.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {
namespace {

void judge(Assessment& a, const CategoryThresholds& limits) {
  a.category = categorise(
      {.drawbar_pull_over_load = a.pull.value, .sinkage_over_radius = a.sinkage_over_radius.value}, limits);
  a.probability = categoryProbability({a.pull, a.sinkage_over_radius}, limits);
}

// Forecasts the pull at other slips from the soil of all rows, at the load of each row. The soil is fitted to
// smooth wheels, so that its strength contains the thrust of the lugs.
void extrapolate(const AssessOptions& options, const WheelRows& rows, const ProgressMonitor& watch,
                 std::vector<Assessment>& result) {
  const TableRows table = tableRows(options.table, "", options.rover, watch);
  const RefinedModel truth = groundTruthOf(soilUnder(table.model, table.trial, {}, watch).model);
  for (std::size_t k = 0; k < result.size() && !watch.stopped(); ++k) {
    const WheelState state{
        .wheel = rows.wheels[k], .load_N = rows.samples[k].load_N, .slip = rows.samples[k].slip};
    result[k].forecast = forecastPull(truth, state, options.reference_slip);
    watch.report(static_cast<double>(k) / static_cast<double>(result.size()));
  }
  watch.report(1.0);
}

AssessedTable assessReadings(const AssessOptions& options, const CategoryThresholds& limits,
                             const ProgressMonitor& watch) {
  const ReadingErrors errors = ReadingErrors::relative(options.noise);
  const WheelRows rows =
      readWheelRows(options.table, {.rover = options.rover, .needs_slip = options.extrapolate}, watch);
  AssessedTable table{.rows = {}, .rejected = rows.rejected, .left_out = {}};
  for (std::size_t k = 0; k < rows.samples.size() && !watch.stopped(); ++k) {
    const WheelSample& s = rows.samples[k];
    const Wheel& wheel = rows.wheels[k];
    const double sinkage = s.sinkage_m / wheel.radius_m;
    Assessment a{.line = rows.lines[k],
                 .slip = s.slip,
                 .pull = pullOverLoadBy(options.formula, wheel, s, errors),
                 .sinkage_over_radius = {sinkage, errors.sinkage.std(sinkage)},
                 .torque_over_load_radius = torqueOverLoadRadius(wheel, s)};
    judge(a, limits);
    table.rows.push_back(a);
  }
  if (options.extrapolate) extrapolate(options, rows, watch, table.rows);
  return table;
}

RefinedModel modelOf(const AssessOptions& options, std::vector<std::string>& left_out) {
  ModelFile file = loadModel(options.model);
  if (!file.soil_given)
    throw InputError({options.model, "defines no soil", "fit one first: talus trace --model-out"});
  if (!options.rover.empty()) file.model.takeRover(loadRover(options.rover));
  for (const Effect& effect : file.model.effects) {
    if (isSensorFault(effect)) left_out.push_back(effect.name);
  }
  return groundTruthOf(file.model);
}

// Returns the measured sinkage, or the model's prediction without a measurement.
Estimate sinkageOf(const std::vector<double>* read, std::size_t row, const WheelState& state,
                   const ModelPull& pull, double noise) {
  if (read == nullptr || !std::isfinite((*read)[row])) return pull.sinkage_over_radius;
  const double sinkage = (*read)[row] / state.wheel.radius_m;
  return {sinkage, noise * sinkage};
}

AssessedTable assessByModel(const AssessOptions& options, const CategoryThresholds& limits,
                            const ProgressMonitor& watch) {
  AssessedTable table;
  const RefinedModel model = modelOf(options, table.left_out);
  TelemetryOptions reading{.required = {"load_N", "slip"}};
  if (model.wheel) reading.wheel_radius_m = model.wheel->radius_m;
  const Telemetry telemetry = readTelemetry(options.table, reading, watch);
  const std::vector<WheelState> states = statesOf(telemetry, model);
  const auto* sinkage = telemetry.find("sinkage_m");
  const auto* torque = telemetry.find("torque_Nm");
  table.rejected = telemetry.rejected;
  for (std::size_t k = 0; k < states.size() && !watch.stopped(); ++k) {
    const ModelPull pull = pullOf(model, states[k]);
    const bool torque_read = torque != nullptr && std::isfinite((*torque)[k]);
    Assessment a{.line = telemetry.lines[k],
                 .slip = states[k].slip,
                 .pull = pull.pull_over_load,
                 .sinkage_over_radius = sinkageOf(sinkage, k, states[k], pull, options.noise),
                 .torque_over_load_radius = torque_read
                                                ? (*torque)[k] / (states[k].wheel.radius_m * states[k].load_N)
                                                : pull.torque_over_load_radius};
    judge(a, limits);
    if (options.extrapolate) a.forecast = forecastPull(model, states[k], options.reference_slip);
    table.rows.push_back(a);
    watch.report(static_cast<double>(k) / static_cast<double>(states.size()));
  }
  watch.report(1.0);
  return table;
}

}  // namespace

AssessedTable assessTable(const AssessOptions& options, const ProgressMonitor& watch) {
  CategoryThresholds limits = thresholds({.slope_rad = options.slope_rad, .margin_rad = options.margin_rad});
  limits.z_threshold = options.z_threshold;
  limits.z_critical = options.z_critical;
  validate(limits);
  return options.model.empty() ? assessReadings(options, limits, watch)
                               : assessByModel(options, limits, watch);
}

}  // namespace talus::terramech
