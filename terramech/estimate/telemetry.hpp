#pragma once

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Measured wheel data, as columns. Reading it from a file: telemetry_reader.hpp.
namespace talus::terramech {

/// A column of a table under another name than Talus knows.
struct MappedColumn {
  std::string known;  ///< "load_N"
  std::string name;   ///< in the file: "Fz"
  std::string
      unit{};  ///< of the file: "kN", "percent"; empty: that of a suffix of the name, else that of `known`
};

/// A CSV file and how its columns are read; converts from the path alone.
struct TableFile {
  TableFile() = default;
  template <typename Name>
  requires std::convertible_to<Name, std::filesystem::path> TableFile(const Name& file)
      : path(std::filesystem::path(file).string()) {}  // NOLINT(google-explicit-constructor)

  std::string path;
  std::vector<MappedColumn> columns{};
  std::vector<std::pair<std::string, double>>
      constants{};                  ///< columns that the file lacks, the same in each row
  std::vector<std::string> also{};  ///< columns that the caller knows besides those of telemetry
  /// Is told what was done to columns, a sentence each. With it, a known column in another unit (`sinkage_mm`) is
  /// converted; without, it is refused.
  std::function<void(const std::string&)> note{};
};

/// A row that was left out, and why.
struct RejectedRow {
  std::size_t line = 0;  ///< in the file, the header being line 1
  std::string reason;    ///< "load_N = -3, must be > 0"
};

/// Rows of wheel telemetry that passed the checks, column by column. Numbers are SI; a missing one is NaN.
/// Columns that Talus does not know are kept: numeric ones are candidate causes when a residual is traced,
/// text ones are groupings.
struct Telemetry {
  /// A column of numbers.
  struct Numbers {
    std::string name;
    std::vector<double> values;
  };
  /// A column of words.
  struct Words {
    std::string name;
    std::vector<std::string> values;
  };

  std::string source;                 ///< the file, for messages
  std::vector<Numbers> numbers;       ///< in the file's order
  std::vector<Words> words;           ///< in the file's order; `run` and `wheel` are always words
  std::vector<std::size_t> lines;     ///< line of each row in the file
  std::vector<RejectedRow> rejected;  ///< in the file's order
  std::size_t repeated = 0;  ///< rows left out since they are earlier ones again (TelemetryOptions::once)
  /// Known columns of rejected rows where they hold numbers, infinite or beyond double (the greatest); else NaN.
  std::vector<Numbers> rejected_numbers;

  /// Rows that can be used.
  std::size_t size() const noexcept { return lines.size(); }

  /// The column of numbers of that name, or null.
  const std::vector<double>* find(std::string_view name) const noexcept;

  /// The column of words of that name, or null.
  const std::vector<std::string>* findWords(std::string_view name) const noexcept;

  /// The column of numbers of that name. Throws InputError naming the file and the column when there is none.
  const std::vector<double>& at(std::string_view name) const;
};

/// The columns of numbers that Talus knows, with their unit as suffix (docs of the interface).
const std::vector<std::string>& knownTelemetryColumns();

}  // namespace talus::terramech
