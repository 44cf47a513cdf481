#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// The columns of a file by the names and in the units that Talus reads, from its own header and what is asked for.
class TableColumns {
 public:
  /// `decimal_commas`: whether numbers may have them. Throws InputError where a column that is asked for is not there, is
  /// mapped twice or beside the known one, or its unit is of another kind.
  TableColumns(std::vector<std::string> header, const TableFile& table, bool decimal_commas);

  const std::vector<std::string>& header() const noexcept { return header_; }

  /// Converts the numbers of a row and adds the constants; a row that is `whole` has nothing but blanks beyond the header.
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
  std::size_t own_ = 0;  ///< columns of the file
  bool decimal_commas_;
};

/// Factor from a unit, as a name or an option has it, to that of a known column; percent of what has none.
/// None where they are of different kinds.
std::optional<double> columnFactor(const std::string& unit, const std::string& known);

}  // namespace talus::terramech
