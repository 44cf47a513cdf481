#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// How the columns of a table are read, as typed.
struct TableOptions {
  std::vector<std::string> columns;  ///< KNOWN=NAME[:UNIT] each
  std::string columns_file;          ///< with a line each
  double radius_m = 0.0;             ///< of the wheel of every row; 0: not given
  double width_m = 0.0;
};

/// Declares --column, --columns, --radius and --width.
void addTableOptions(CLI::App& command, TableOptions& options);

/// The table with its columns as asked; what was done to them goes to stderr as warnings, once. `also`: columns that the call
/// knows besides those of telemetry. @throws InputError
terramech::TableFile tableFile(const std::string& path, const TableOptions& options, const Context& context,
                               const std::vector<std::string>& also = {});

}  // namespace talus::cli
