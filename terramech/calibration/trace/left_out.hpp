#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

/// The whole loop on rows that the search never saw: which effects there are, and their parameters, come from the
/// other rows alone.
namespace talus::terramech {

/// Rows to leave out together, and how they are called.
struct LeftOut {
  std::string what;  ///< "slip_angle_rad = 0.7854"
  std::vector<char> rows;
};

/// What `request` names: COLUMN leaves out each of its levels in turn (ten bands where it has more than twelve),
/// COLUMN=VALUE,VALUE the rows with one of these values or words, COLUMN=LOW..HIGH those from LOW to HIGH. Throws
/// InputError, with `source`, where the column is unknown or no row, or every row, is left out.
std::vector<LeftOut> leftOut(const Trial& trial, const std::string& request, const std::string& source);

/// Errors on rows left out, and what was foretold of them.
struct LeftOutErrors {
  std::string what;
  int rows = 0;
  std::vector<std::string> effects;  ///< found without them: name (column)
  ChannelErrors base{}, refined{}, floor{};
  ChannelErrors regression{};  ///< of a plain regression: columns and their squares, ridge by generalised
                               ///< cross-validation (golub_1979); 0 knowledge of wheels, for scale
  Trial trial;                 ///< the rows left out
  Eigen::MatrixXd base_told, told;  ///< of them, by the base and the refined model: rows x kChannels [-]
};

LeftOutErrors traceWithout(const RefinedModel& base, const Trial& trial, const LeftOut& left,
                           const TraceOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
