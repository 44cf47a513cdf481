#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace talus::terramech {

/// One record of a CSV file.
struct CsvRow {
  std::size_t line = 0;  ///< where it begins, the header being line 1 unless blank lines precede it
  std::vector<std::string> fields;  ///< without quotes and surrounding blanks
  std::string fault;  ///< why the record cannot be used, empty when it can: "has 3 fields, the header 7"
};

/// Streams a CSV file with a header row, through libcsv, 64 KiB at a time. Skips blank lines and UTF-8 byte
/// order marks, takes LF, CRLF and CR. Not copyable; use from one thread.
class CsvReader {
 public:
  /// Throws InputError when the file cannot be read, is not text, has no header, or a name stands twice in
  /// it.
  explicit CsvReader(const std::filesystem::path& path);
  ~CsvReader();
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Column names in order; unnamed columns are empty.
  const std::vector<std::string>& header() const noexcept;

  /// The next record, or false at the end. A record that is cut short, too long or repeats the header is handed out with its
  /// fault. Throws InputError where a stray quote holds other rows: it is never closed, or what it holds has line breaks and
  /// commas.
  bool next(CsvRow& row);

  /// Share of the file read so far, 0 to 1.
  double fraction() const noexcept;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// The number that a whole field states ("1", "-2.5e3", "+4", "nan", "inf"), or false. `.` decimals whatever
/// the locale.
bool parseNumber(std::string_view field, double& value) noexcept;

/// A field as it stands in a CSV file: in quotes where it holds a comma, a quote, a line break or outer
/// blanks.
std::string csvField(std::string_view text);

}  // namespace talus::terramech
