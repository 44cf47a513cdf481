#include <cmath>

#include <talus/terramech/calibration/tables/table_applicability.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {
namespace {

constexpr int kFewest = 20, kMost = 400;

/// Every so many rows of those whose contact the model describes, at most kMost.
Trial evenRows(const Trial& trial) {
  std::vector<char> keep = beyondAxle(trial);
  for (char& row : keep) row = !row;
  const Trial usable = subset(trial, keep);
  const int step = (usable.rows() + kMost - 1) / kMost;
  if (step < 2) return usable;
  std::vector<char> some;
  for (int row = 0; row < usable.rows(); ++row) some.push_back(row % step == 0);
  return subset(usable, some);
}

}  // namespace

Applicability tableApplicability(const std::string& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch) {
  ModelFile file = base.empty() ? unknownSoil() : loadModel(base);
  if (!rover.empty()) file.model.takeRover(loadRover(rover));
  Telemetry telemetry = readTelemetry(table, {});
  leaveOutWithoutSlipAngle(telemetry);
  const bool wheel =
      file.model.wheel || (telemetry.find("wheel_radius_m") && telemetry.find("wheel_width_m"));
  if (!wheel || !telemetry.find("load_N") || !telemetry.find("slip")) return {};
  if (!telemetry.find("sinkage_m") && !telemetry.find("torque_Nm") && !telemetry.find("drawbar_pull_N"))
    return {};
  const Trial trial = evenRows(makeTrial(telemetry, file.model));
  if (trial.rows() < kFewest) return {};
  file.model.slip_along_travel |= slipIsAlongTravel(trial.states);
  TraceOptions options{.max_effects = 0};
  options.fit_soil = !file.soil_given;
  const Applicability plain = applicability(traceResiduals(file.model, trial, options), options);
  if (plain.applies || watch.stopped()) return plain;
  options.max_effects = TraceOptions{}.max_effects;
  const Applicability traced = applicability(traceResiduals(file.model, trial, options, watch), options);
  return watch.stopped() ? Applicability{} : traced;
}

}  // namespace talus::terramech
