#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

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
