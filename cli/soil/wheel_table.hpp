#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::cli {

/// What became of a table of wheel cases.
struct WheelTable {
  std::size_t solved = 0;
  std::vector<terramech::RejectedRow> refused;  ///< kept in the output with empty results
  bool replaced = false;                        ///< the input had result columns, which were replaced
};

/// The columns that cases have.
std::vector<std::string> wheelCaseColumns();

/// Solves each row of a CSV of wheel cases and writes all its columns with sinkage_m, entry_angle_rad,
/// torque_Nm and drawbar_pull_N after them, and side_force_N where the table has a column slip_angle_rad;
/// without it every wheel rolls straight. Streams; solves on `threads` threads, >= 1; the same bytes whatever
/// their number. The output appears whole or not at all. Throws InputError when the input cannot be read,
/// lacks a column, or no row can be solved.
WheelTable solveWheelTable(const terramech::TableFile& input, const std::filesystem::path& output,
                           int threads, const ProgressMonitor& watch);

}  // namespace talus::cli
