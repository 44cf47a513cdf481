#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/field_number.hpp>

namespace talus::terramech {

/// One record of a CSV file.
struct CsvRow {
  std::size_t line = 0;  ///< where it begins, the header being line 1 unless blank lines precede it
  std::vector<std::string> fields;  ///< without quotes and surrounding blanks
  std::string fault;  ///< why the record cannot be used, empty when it can: "has 3 fields, the header 7"
};

/// Streams a CSV file with a header row, through libcsv, 64 KiB at a time. Skips blank lines and UTF-8 byte
/// order marks, takes LF, CRLF and CR; fields are parted by commas or, where the header has more of them, by semicolons or
/// tabs, and numbers may then have a decimal comma. Columns are named and in the unit that the TableFile asks for. Not
/// copyable; use from one thread.
class CsvReader {
 public:
  /// Throws InputError when the file cannot be read, is not text, has no header, a name stands twice in it, or a column
  /// cannot be mapped.
  explicit CsvReader(const TableFile& table);
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

/// A field as it stands in a CSV file: in quotes where it holds a comma, a quote, a line break or outer
/// blanks.
std::string csvField(std::string_view text);

}  // namespace talus::terramech
