#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::cli {

/// Counts of a processed table of wheel cases. A case is a wheel at given load and slip on a soil.
struct WheelCaseTable {
  /// Number of solved rows.
  std::size_t solved = 0;
  std::vector<terramech::RejectedRow> refused;  ///< rejected rows, which are written with empty results
  bool replaced = false;  ///< true if the input had result columns, which were overwritten
};

/// Returns the names of the input columns of a case.
std::vector<std::string> wheelCaseColumns();

/// Solves each row of a CSV table of wheel cases. Writes all input columns, then sinkage_m, entry_angle_rad,
/// torque_Nm, drawbar_pull_N, and side_force_N if the table has a column slip_angle_rad; without that column
/// the slip angle is 0. Processes the file as a stream on `threads` >= 1 threads; the output does not depend
/// on the number of threads. The output file appears complete or not at all. Throws InputError if the input
/// cannot be read, lacks a column, or has no row that can be solved.
WheelCaseTable solveWheelTable(const terramech::TableFile& input, const std::filesystem::path& output,
                               int threads, const ProgressMonitor& watch);

}  // namespace talus::cli
