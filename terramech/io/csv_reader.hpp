#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/field_text.hpp>

namespace talus::terramech {

/// One record of a CSV file.
struct CsvRow {
  /// Line number at which the record begins. The header is line 1 unless blank lines precede it.
  std::size_t line = 0;
  std::vector<std::string> fields;  ///< texts without quotes and without leading or trailing blanks
  std::string fault;  ///< why the record is unusable ("has 3 fields, the header 7"); empty if usable
};

/// Reader of a CSV file with a header row, which parses 64 KiB at a time through libcsv. Blank lines and
/// UTF-8 byte order marks are skipped, and lines that begin with # (behind the header: with a field #, or as
/// one field); the line ends LF, CRLF and CR are accepted. The separator is the most frequent of comma,
/// semicolon and tab in the header, or blanks if it has none of them; except with commas, numbers may have a
/// decimal comma. A row of units below the header is part of it (takeUnits()). Columns are renamed and converted as the TableFile requests. Not copyable; not thread-safe.
class CsvReader {
 public:
  /// Opens the file and reads its header. Throws InputError if the file cannot be read, is not text, has no
  /// header or more than 1000 columns, if a name occurs twice, or if a column cannot be mapped.
  explicit CsvReader(const TableFile& table);
  ~CsvReader();
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Returns the column names in order. The name of an unnamed column is empty.
  const std::vector<std::string>& header() const noexcept;

  /// Reads the next record into `row`; returns false at the end of the file. A record that is too short, too
  /// long or equal to the header is returned with its fault. Throws InputError if a stray quote encloses
  /// other rows: an unclosed quote, or a quoted field with line breaks and separators.
  bool next(CsvRow& row);

  /// Returns the fraction of the file that has been read, 0 to 1.
  double fraction() const noexcept;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Returns a text as a field of a CSV file. The field is in quotes if it contains a comma, a quote, a line
/// break, or a leading or trailing blank.
std::string csvField(std::string_view text);

}  // namespace talus::terramech
