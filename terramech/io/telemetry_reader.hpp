#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Options of readTelemetry().
struct TelemetryOptions {
  /// Numeric columns that must exist; a row without a value in one of them is rejected.
  std::vector<std::string> required;
  /// Wheel radius for the sinkage check if the file has no wheel_radius_m; 0: unknown.
  double wheel_radius_m = 0.0;
  /// True: a row that equals an earlier row in every field, including time_s, is left out and counted in
  /// Telemetry::repeated. Rows at the same time are compared only if the file has a column `wheel`.
  bool once = false;
};

/// Reads telemetry of wheels from a CSV file with a header row and columns in any order (CsvReader). An empty
/// field is a missing value. A row is rejected, with line and reason in Telemetry::rejected, if a known
/// column contains text, NaN, infinity or a value outside its range (load <= 0, sinkage outside [0, 2r), slip
/// outside [-1, 1], ...), if a required field is empty, or if the row has a wrong number of fields. In
/// unknown columns NaN is a missing value. The columns are kept in memory, not the text of the file. Throws
/// InputError if the file cannot be read, has no header, has a column twice or in another unit or spelling
/// (column_units.hpp), lacks a required column, or has no usable row.
Telemetry readTelemetry(const TableFile& table, const TelemetryOptions& options = {},
                        const ProgressMonitor& watch = {});

}  // namespace talus::terramech
