#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/model_file.hpp>

namespace talus::terramech {

/// Result of predictTable().
struct PredictionTable {
  std::string text;                  ///< the CSV with predictions appended
  std::size_t predicted = 0;         ///< number of rows with predictions
  std::vector<RejectedRow> refused;  ///< rows without predictions; their fields are empty
  std::size_t outside = 0;           ///< rows outside the trained range of some column
  bool replaced = false;             ///< the input contained prediction columns, which were replaced
};

/// Appends predictions to every row of a CSV: predicted_drawbar_pull_N, predicted_sinkage_m,
/// predicted_torque_Nm, predicted_side_force_N, their _std, and predicted_outside: the columns, separated by
/// semicolons, in which the row is outside the trained range. Outside this range the _std grow with the
/// distance, and predictions return to the base model where the scope excludes the corrections. Measured
/// answers (drawbar_pull_N, sinkage_m, torque_Nm, side_force_N) are copied and not used. Throws InputError if
/// the file cannot be read or lacks load_N, slip or wheel dimensions. After a stop by the watch the text is
/// incomplete.
PredictionTable predictTable(const TableFile& file, const RefinedModel& model, const ModelScope& scope = {},
                             const ProgressMonitor& watch = {});

}  // namespace talus::terramech
