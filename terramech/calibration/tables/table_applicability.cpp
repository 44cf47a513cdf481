#include <vector>

#include <talus/terramech/calibration/table/model_rows.hpp>
#include <talus/terramech/calibration/tables/table_applicability.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace talus::terramech {
namespace {

constexpr int kFewest = 20, kMost = 400;

/// Evenly spaced rows of a trial, at most kMost.
Trial evenRows(const Trial& trial) {
  const int step = (trial.rows() + kMost - 1) / kMost;
  if (step < 2) return trial;
  std::vector<char> some;
  for (int row = 0; row < trial.rows(); ++row) some.push_back(row % step == 0);
  return subset(trial, some);
}

}  // namespace

Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch) {
  const ModelFile file = baseModel(base, rover);
  const Telemetry telemetry = readTelemetry(table, {});
  const bool wheel =
      file.model.wheel || (telemetry.find("wheel_radius_m") && telemetry.find("wheel_width_m"));
  if (!wheel || !telemetry.find("load_N") || !telemetry.find("slip")) return {};
  if (!telemetry.find("sinkage_m") && !telemetry.find("torque_Nm") && !telemetry.find("drawbar_pull_N"))
    return {};
  const ModelRows rows = modelRows(telemetry, file.model);
  const Trial trial = evenRows(rows.trial);
  if (trial.rows() < kFewest) return {};
  TraceOptions options{.max_effects = 0};
  options.fit_soil = !file.soil_given;
  const Applicability plain = applicability(traceResiduals(rows.model, trial, options), options);
  if (plain.applies || watch.stopped()) return plain;
  options.max_effects = TraceOptions{}.max_effects;
  const Applicability traced = applicability(traceResiduals(rows.model, trial, options, watch), options);
  return watch.stopped() ? Applicability{} : traced;
}

}  // namespace talus::terramech
