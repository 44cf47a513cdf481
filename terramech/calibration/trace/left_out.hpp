#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

/// Cross-validation of the complete tracing procedure: effects and parameters are determined from the other
/// rows only.
namespace talus::terramech {

/// Rows left out together, with a label.
struct LeftOut {
  std::string what;  ///< "slip_angle_rad = 0.7854"
  std::vector<char> rows;
};

/// Rows to leave out according to `request`: COLUMN leaves out each of its levels in turn (ten bands for more
/// than twelve levels), COLUMN=VALUE,VALUE the rows with one of these values, COLUMN=LOW..HIGH the rows in
/// the range. Throws InputError, with `source`, if the column is unknown or if no row or every row would be
/// left out.
std::vector<LeftOut> leftOut(const Trial& trial, const std::string& request, const std::string& source);

/// Errors and predictions of rows left out.
struct LeftOutErrors {
  std::string what;
  int rows = 0;
  std::vector<std::string> effects;  ///< found without these rows: name (column)
  ChannelErrors base{}, refined{}, floor{};
  ChannelErrors regression{};  ///< plain regression for comparison: columns and squares, ridge by generalised
                               ///< cross-validation (golub_1979)
  Trial trial;                 ///< the rows left out
  Eigen::MatrixXd base_predicted, predicted;  ///< predictions of base and refined model: rows x kChannels [-]
};

LeftOutErrors traceWithout(const RefinedModel& base, const Trial& trial, const LeftOut& left,
                           const TraceOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
