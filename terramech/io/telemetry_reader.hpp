#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Options of readTelemetry().
struct TelemetryOptions {
  /// Numeric columns that must exist and have a value in every used row.
  std::vector<std::string> required;
  double wheel_radius_m = 0.0;  ///< for the sinkage check if the file has no wheel_radius_m; 0: unknown
  /// True: a row that equals an earlier one in every field, including time_s, is left out and counted in
  /// Telemetry::repeated. Rows of the same moment are compared only if column `wheel` is given.
  bool once = false;
};

/// Reads a telemetry CSV with a header row, columns in any order; format: CsvReader. Empty fields are missing
/// values. A row is left out, with line and reason in Telemetry::rejected, if a known column contains text,
/// NaN, infinity or a value outside its range (load <= 0, sinkage outside [0, 2r), slip outside [-1, 1],
/// ...), if a required field is empty, or if the row has a wrong number of fields. In unknown columns NaN is
/// a missing value. The columns are kept in memory, not the text of the file. Throws InputError if the file
/// cannot be read, has no header, has a column twice or in another unit or spelling (column_units.hpp), lacks
/// a required column, or has no usable row.
Telemetry readTelemetry(const TableFile& table, const TelemetryOptions& options = {},
                        const ProgressMonitor& watch = {});

}  // namespace talus::terramech
