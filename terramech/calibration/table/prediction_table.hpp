#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

/// Result of predictTable(): a telemetry table with predictions of a wheel model.
struct PredictionTable {
  std::string text;           ///< text of the CSV file with prediction columns appended
  std::size_t predicted = 0;  ///< number of rows with predictions
  /// Rows without predictions, with the reason; their prediction fields are empty.
  std::vector<RejectedRow> refused;
  std::size_t outside = 0;  ///< number of rows outside the trained range of some column
  bool replaced = false;    ///< true: the input contained prediction columns, which were replaced
};

/// Appends the predictions of a model to every row of a CSV file. The new columns are
/// predicted_drawbar_pull_N, predicted_sinkage_m, predicted_torque_Nm, predicted_side_force_N, their standard
/// deviations (suffix _std), and predicted_outside, which lists the columns in which the row is outside the
/// trained range, separated by semicolons. Outside this range the standard deviations grow with the distance,
/// and the predictions return to those of the base model where `scope` excludes the corrections. Measured
/// answers (drawbar_pull_N, sinkage_m, torque_Nm, side_force_N) are copied and not used. A row without the column
/// of an effect of the model is refused. Throws InputError if
/// the file cannot be read or lacks load_N, slip or wheel dimensions. After a stop by the watch the text is
/// incomplete.
PredictionTable predictTable(const TableFile& file, const RefinedModel& model, const ModelScope& scope = {},
                             const ProgressMonitor& watch = {});

}  // namespace talus::terramech
