#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// How telemetry is read.
struct TelemetryOptions {
  /// Columns of numbers that must be there, and filled in every row that is used.
  std::vector<std::string> required;
  double wheel_radius_m = 0.0;  ///< for the sinkage check where the file has no wheel_radius_m; 0: not known
  /// Whether a row that equals an earlier one in every field, time_s among them, is left out and counted in
  /// Telemetry::repeated; of the same moment only where column `wheel` names both.
  bool once = false;
};

/// Reads a telemetry CSV: header row, columns in any order, decimal points, UTF-8 with or without a byte order
/// mark, LF or CRLF, quoted fields, empty field = missing. A row is left out, with line and reason in
/// Telemetry::rejected, when a known column holds NaN, infinity or words, when a required field is empty, the
/// load is not above 0, the sinkage is outside [0, 2r), the slip outside [-1, 1], a wheel dimension out of
/// range, or the row is cut short. In unknown columns NaN counts as missing. Read in pieces: memory holds the
/// columns, never the file. Throws InputError when the file cannot be read, has no header or one with a name
/// twice or with a known column in another unit than it is read in (column_units.hpp), lacks a required column,
/// or no row can be used.
Telemetry readTelemetry(const TableFile& table, const TelemetryOptions& options = {},
                        const ProgressMonitor& watch = {});

}  // namespace talus::terramech
