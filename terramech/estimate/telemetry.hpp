#pragma once

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Measured wheel data, as columns. File reader: telemetry_reader.hpp.
namespace talus::terramech {

/// Maps a column of a file to a known column of another name.
struct MappedColumn {
  std::string known;  ///< name in Talus: "load_N"
  std::string name;   ///< name in the file: "Fz"
  std::string
      /// Unit in the file: "kN", "percent"; empty: the suffix of the name, otherwise the unit of `known`.
      unit{};
};

/// CSV file with options for its columns; converts implicitly from a path.
struct TableFile {
  TableFile() = default;
  template <typename Name>
  requires std::convertible_to<Name, std::filesystem::path> TableFile(const Name& file)
      : path(std::filesystem::path(file).string()) {}  // NOLINT(google-explicit-constructor)

  std::string path;
  std::vector<MappedColumn> columns{};  ///< columns with another name or unit in the file
  std::vector<std::pair<std::string, double>>
      constants{};                  ///< columns missing in the file, with the same value in each row
  std::vector<std::string> also{};  ///< additional columns known to the caller
  /// Callback with one sentence for each change to a column. With a callback, a known column in another unit
  /// (`sinkage_mm`) is converted; without a callback, such a column is an error.
  std::function<void(const std::string&)> note{};
};

/// Rejected row, with the reason.
struct RejectedRow {
  std::size_t line = 0;  ///< line in the file; the header is line 1
  std::string reason;    ///< "load_N = -3, must be > 0"
};

/// Rows of wheel telemetry that passed the checks, stored by column. Numbers are SI; missing ones are NaN.
/// Unknown columns are kept: numeric ones as candidate causes of residuals, text ones as groupings.
struct Telemetry {
  /// Numeric column.
  struct Numbers {
    std::string name;
    std::vector<double> values;
  };
  /// Text column.
  struct Words {
    std::string name;
    std::vector<std::string> values;
  };

  std::string source;                 ///< file name, for messages
  std::vector<Numbers> numbers;       ///< in the order of the file
  std::vector<Words> words;           ///< in the order of the file; `run` and `wheel` are always text
  std::vector<std::size_t> lines;     ///< line of each row in the file
  std::vector<RejectedRow> rejected;  ///< in the order of the file
  std::size_t repeated = 0;  ///< rows left out as repetitions of earlier rows (TelemetryOptions::once)
  /// Known columns in rejected rows, as read: infinite values are kept, values beyond double are the largest
  /// double, other text is NaN.
  std::vector<Numbers> rejected_numbers;

  /// Returns the number of usable rows.
  std::size_t size() const noexcept { return lines.size(); }

  /// Returns the numeric column of this name, or null.
  const std::vector<double>* find(std::string_view name) const noexcept;

  /// Returns the text column of this name, or null.
  const std::vector<std::string>* findWords(std::string_view name) const noexcept;

  /// Returns the numeric column of this name. Throws InputError with file and column if there is none.
  const std::vector<double>& at(std::string_view name) const;
};

/// Returns the names of the known numeric columns, with their unit as suffix.
const std::vector<std::string>& knownTelemetryColumns();

}  // namespace talus::terramech
