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
  /// Line on which the record begins; the header is line 1 unless blank lines precede it.
  std::size_t line = 0;
  std::vector<std::string> fields;  ///< without quotes and without leading or trailing blanks
  std::string fault;  ///< why the record is unusable, empty if usable: "has 3 fields, the header 7"
};

/// Streams a CSV file with a header row through libcsv, 64 KiB at a time. Skips blank lines and UTF-8 byte
/// order marks; accepts LF, CRLF and CR. The separator is the most frequent of comma, semicolon and tab in
/// the header; with semicolons or tabs, numbers may have a decimal comma. Columns have the names and units
/// that the TableFile requests. Not copyable; not thread-safe.
class CsvReader {
 public:
  /// Throws InputError if the file cannot be read, is not text, has no header or more than 1000 columns, a
  /// name occurs twice, or a column cannot be mapped.
  explicit CsvReader(const TableFile& table);
  ~CsvReader();
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Returns the column names in order; unnamed columns are empty.
  const std::vector<std::string>& header() const noexcept;

  /// Reads the next record; returns false at the end. A record that is too short, too long or repeats the
  /// header is returned with its fault. Throws InputError if a stray quote encloses other rows: an unclosed
  /// quote, or a quoted field with line breaks and separators.
  bool next(CsvRow& row);

  /// Returns the fraction of the file read so far, 0 to 1.
  double fraction() const noexcept;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Returns a field as written in a CSV file: in quotes if it contains a comma, a quote, a line break, or a
/// leading or trailing blank.
std::string csvField(std::string_view text);

}  // namespace talus::terramech
