#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

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

}  // namespace talus::cli
