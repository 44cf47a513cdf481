#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Options for reading the columns of a table, as entered.
struct TableOptions {
  /// Assignments KNOWN=NAME[:UNIT] of known columns to columns of the file.
  std::vector<std::string> columns;
  std::string columns_file;  ///< file with one such assignment per line
  double radius_m = 0.0;     ///< wheel radius of all rows; 0: not given
  /// Wheel width of all rows; 0: not given.
  double width_m = 0.0;
};

/// Declares the options --column, --columns, --radius and --width.
void addTableOptions(CLI::App& command, TableOptions& options);

/// Returns the table with its columns assigned as specified. Unit conversions are printed as warnings, once.
/// `also` contains the columns that the call knows in addition to those of telemetry. @throws InputError
terramech::TableFile tableFile(const std::string& path, const TableOptions& options, const Context& context,
                               const std::vector<std::string>& also = {});

/// Warns of rejected rows of a table, of the first twenty each with its reason.
void warnOfRejected(const std::vector<terramech::RejectedRow>& rows, const std::string& path,
                    const Context& context);

/// Returns rejected rows as JSON: [{line, reason}].
nlohmann::ordered_json rejectedJson(const std::vector<terramech::RejectedRow>& rows);

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
