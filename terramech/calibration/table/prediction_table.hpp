#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/model_file.hpp>

namespace talus::terramech {

/// What predictTable() did.
struct PredictionTable {
  std::string text;                  ///< the CSV with predictions appended
  std::size_t predicted = 0;         ///< rows with predictions
  std::vector<RejectedRow> refused;  ///< rows without, their fields left empty
  std::size_t outside = 0;           ///< rows outside the trained range of some column
  bool replaced = false;             ///< the input held columns of predictions; they are replaced
};

/// Every row of a CSV with predicted_drawbar_pull_N, predicted_sinkage_m, predicted_torque_Nm,
/// predicted_side_force_N and their _std appended, and predicted_outside: the columns, a semicolon between, in which
/// the row lies outside the range that the model was fitted to; there the _std grow with the distance, and where
/// the scope takes corrections back the predictions return to the base model's. What was measured (drawbar_pull_N, sinkage_m, torque_Nm,
/// side_force_N) is copied, never used. Throws InputError when the file cannot be read or has no load_N, slip
/// or wheel. Stopped by its watch it ends early, the text unfinished.
PredictionTable predictTable(const TableFile& file, const RefinedModel& model, const ModelScope& scope = {},
                             const ProgressMonitor& watch = {});

}  // namespace talus::terramech
