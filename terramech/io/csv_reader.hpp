#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Parses a whole text field as a number ("1", "-2.5e3", "+4", "nan", "inf"), with `.` as decimal point in
/// any locale. Returns false if the field is not a number.
bool parseNumber(std::string_view field, double& value) noexcept;

/// Parses all fields of a column; a field that is empty or not finite becomes NaN. Returns false if a field is not a
/// number, or if all fields are empty; `numbers` is then unspecified.
bool allNumbers(const std::vector<std::string>& fields, std::vector<double>& numbers);

/// Returns true if a text is valid UTF-8 without NUL characters.
bool isText(std::string_view text);

/// Returns the factor between two units of the same kind: value in `to` = factor * value in `from`. Units
/// have the names of column suffixes, for example "deg" and "rad". Returns nullopt if the units are of
/// different kinds or a unit is unknown.
std::optional<double> conversion(std::string_view from, std::string_view to);

/// Returns the names of all units of the same kind, for messages ("N, mN, kN"); an empty text for an unknown
/// unit.
std::string unitsLike(std::string_view unit);

/// Returns the longest known unit that follows an underscore at the end of a name ("kPa" of "cohesion_kPa"),
/// or an empty text.
std::string_view unitOf(std::string_view name);

/// Returns a name without its unit ("cohesion" of "cohesion_kPa").
std::string stemOf(std::string_view name);

/// Returns a name with separators replaced by `_` and the signs % and degree by words: "load [N]" becomes "load_N".
std::string plainName(std::string_view name);

/// Appends the units of a row below the header ("N", "[m/s]", "%") to the names. Returns false and changes nothing if
/// a field is a number or none is a known unit. @throws InputError if a name states another unit
bool takeUnits(std::vector<std::string>& header, const std::vector<std::string>& row,
               const std::string& file);

/// Throws InputError if the header of a file contains a known column under another name or unit. The message
/// names file and column, and the name and unit to write. Without this check the column would count as an
/// unknown column, and its measurements would be ignored. Errors are another unit (`sinkage_mm` for
/// `sinkage_m`; a mass for a force, percent for a ratio or an angle), a missing unit (`sinkage`; except time
/// and axes), and another spelling (`Load_N`, `load [N]`). `known` lists the known columns with their unit as
/// suffix. Any other name (`sinkage_note`, `load_cell_id`) is accepted as an unknown column, and so is any
/// name in a file that also contains the known column.
void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file);

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

/// Columns of a table, converted from the names and units of a file to those of Talus. The options of the
/// TableFile specify names and units of the file.
class TableColumns {
 public:
  /// `header` contains the column names of the file. With decimal_commas, numbers may have a decimal comma.
  /// Throws InputError if a mapped column is missing or mapped twice, if the known column exists as well, or
  /// if the unit is of another kind.
  TableColumns(std::vector<std::string> header, const TableFile& table, bool decimal_commas);

  const std::vector<std::string>& header() const noexcept { return header_; }

  /// Converts the fields of a row to the units of Talus and appends the constant columns. With `whole`, blank
  /// fields beyond the header are removed first.
  void apply(std::vector<std::string>& fields, bool whole) const;

 private:
  struct Conversion {
    std::size_t column;
    double factor;
  };

  void map(const MappedColumn& mapped, const TableFile& table);
  void convertUnits(const TableFile& table);
  void nameLookalikes(const TableFile& table) const;
  bool has(const std::string& name) const;

  std::vector<std::string> header_;
  std::vector<Conversion> conversions_;
  std::vector<std::string> constants_;
  std::size_t own_ = 0;  ///< number of columns in the file
  bool decimal_commas_;
};

/// Returns the factor from `unit` to the unit of the known column `known`. For a column without unit, percent
/// and permille are accepted. Returns nullopt for units of different kinds.
std::optional<double> columnFactor(const std::string& unit, const std::string& known);

}  // namespace talus::terramech
