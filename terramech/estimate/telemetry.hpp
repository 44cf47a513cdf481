#pragma once

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Measured data of wheels, stored by column. The reader of CSV files is terramech_io.hpp.
namespace talus::terramech {

/// Maps a column of a file to a known column, whose name in Talus differs.
struct MappedColumn {
  std::string known;  ///< name in Talus, for example "load_N"
  std::string name;   ///< name in the file, for example "Fz"
  /// Unit in the file, for example "kN" or "percent"; empty: the suffix of `name`, otherwise the unit of
  /// `known`.
  std::string unit{};
};

/// CSV file with options for its columns. Converts implicitly from a path.
struct TableFile {
  TableFile() = default;
  template <typename Name>
  requires std::convertible_to<Name, std::filesystem::path> TableFile(const Name& file)
      : path(std::filesystem::path(file).string()) {}  // NOLINT(google-explicit-constructor)

  std::string path;
  std::vector<MappedColumn> columns{};  ///< columns that have another name or unit in the file
  /// Columns that are missing in the file, each with one value for all rows.
  std::vector<std::pair<std::string, double>> constants{};
  std::vector<std::string> also{};  ///< names of additional columns that count as known
  /// Callback that receives one sentence for each change to a column. With a callback, a known column in
  /// another unit (`sinkage_mm`) is converted; without a callback, such a column is an error.
  std::function<void(const std::string&)> note{};
};

/// Row of a file that was rejected, with the reason.
struct RejectedRow {
  std::size_t line = 0;  ///< line number in the file; the header is line 1
  std::string reason;    ///< reason, for example "load_N = -3, must be > 0"
};

/// Rows of wheel telemetry that passed the checks, stored by column. Numbers are in SI units; a missing
/// number is NaN. Unknown columns are kept: numeric columns as candidate causes of residuals, text columns as
/// groupings.
struct Telemetry {
  /// Numeric column with one value per row.
  struct Numbers {
    std::string name;
    std::vector<double> values;
  };
  /// Text column with one value per row.
  struct Words {
    std::string name;
    std::vector<std::string> values;
  };

  std::string source;            ///< file name, for messages
  std::vector<Numbers> numbers;  ///< numeric columns in the order of the file
  std::vector<Words> words;      ///< text columns in the order of the file; `run` and `wheel` are always text
  std::vector<std::size_t> lines;     ///< line number of each row in the file
  std::vector<RejectedRow> rejected;  ///< rejected rows in the order of the file
  /// Number of rows left out as repetitions of earlier rows (TelemetryOptions::once).
  std::size_t repeated = 0;
  /// Known numeric columns of the rejected rows. Infinite values are kept, values beyond the range of double
  /// are the largest double, and other text is NaN.
  std::vector<Numbers> rejected_numbers;

  /// Returns the number of usable rows.
  std::size_t size() const noexcept { return lines.size(); }

  /// Returns the numeric column of this name, or null if there is no such column.
  const std::vector<double>* find(std::string_view name) const noexcept;

  /// Returns the text column of this name, or null if there is no such column.
  const std::vector<std::string>* findWords(std::string_view name) const noexcept;

  /// Returns the numeric column of this name. Throws InputError with file and column if there is no such
  /// column.
  const std::vector<double>& at(std::string_view name) const;
};

/// Returns the names of the known numeric columns, with their unit as suffix.
const std::vector<std::string>& knownTelemetryColumns();

}  // namespace talus::terramech
