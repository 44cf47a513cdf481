#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Columns of a file with the names and units of Talus, from the header of the file and the options of the
/// TableFile.
class TableColumns {
 public:
  /// `decimal_commas`: numbers may have decimal commas. Throws InputError if a mapped column is missing or
  /// mapped twice, the known column also exists, or the unit is of another kind.
  TableColumns(std::vector<std::string> header, const TableFile& table, bool decimal_commas);

  const std::vector<std::string>& header() const noexcept { return header_; }

  /// Converts the numbers of a row and appends the constants. With `whole`, blank fields beyond the header
  /// are removed first.
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

/// Returns the factor from a unit to that of a known column; percent and permille if the column has no unit.
/// Empty for units of different kinds.
std::optional<double> columnFactor(const std::string& unit, const std::string& known);

}  // namespace talus::terramech
