#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Options for reading the columns of a table, as entered.
struct TableOptions {
  std::vector<std::string> columns;  ///< each KNOWN=NAME[:UNIT]
  std::string columns_file;          ///< file with one such entry per line
  double radius_m = 0.0;             ///< wheel radius of all rows; 0: not given
  double width_m = 0.0;
};

/// Declares --column, --columns, --radius and --width.
void addTableOptions(CLI::App& command, TableOptions& options);

/// The table with its columns mapped as specified. Conversions are printed as warnings, once. `also`: columns
/// known to the call in addition to those of telemetry. @throws InputError
terramech::TableFile tableFile(const std::string& path, const TableOptions& options, const Context& context,
                               const std::vector<std::string>& also = {});

}  // namespace talus::cli
