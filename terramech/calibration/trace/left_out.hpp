#pragma once

#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

/// Cross-validation of the complete procedure of residual tracing: effects and parameters are determined
/// without the rows that are left out.
namespace talus::terramech {

/// Set of rows that are left out together, with a label.
struct LeftOut {
  std::string what;        ///< label, for example "slip_angle_rad = 0.7854"
  std::vector<char> rows;  ///< non-zero: the row is left out
};

/// Returns the sets of rows that `request` specifies. COLUMN leaves out each level of the column (rows with
/// the same value) in turn, or ten bands if there are more than twelve levels. COLUMN=VALUE,VALUE leaves out
/// the rows with one of these values, and COLUMN=LOW..HIGH the rows in this range. Throws InputError, with
/// `source` as location, if the column is unknown or if no row or every row would be left out.
std::vector<LeftOut> leftOut(const Trial& trial, const std::string& request, const std::string& source);

/// Errors and predictions for a set of rows that was left out.
struct LeftOutErrors {
  std::string what;                  ///< label of the set
  int rows = 0;                      ///< number of rows
  std::vector<std::string> effects;  ///< effects found without these rows, as "name (column)"
  /// Errors of the base and the refined model, and noise floor.
  ChannelErrors base{}, refined{}, floor{};
  /// Errors of a plain regression for comparison: columns and their squares, ridge by generalised
  /// cross-validation (golub_1979).
  ChannelErrors regression{};
  Trial trial;  ///< rows that were left out
  /// Predictions of the base and the refined model, rows x kChannels [-].
  Eigen::MatrixXd base_predicted, predicted;
};

/// Traces the residuals of `base` without the rows of `left`, and returns the errors on these rows.
LeftOutErrors traceWithout(const RefinedModel& base, const Trial& trial, const LeftOut& left,
                           const TraceOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
