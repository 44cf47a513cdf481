#pragma once

#include <map>
#include <string>
#include <vector>

namespace talus::terramech::test {

/// One row of a reference table. An unknown column throws std::out_of_range.
class ReferenceRow {
 public:
  explicit ReferenceRow(std::map<std::string, std::string> cells);

  const std::string& text(const std::string& column) const { return cells_.at(column); }
  bool has(const std::string& column) const { return !text(column).empty(); }
  double operator[](const std::string& column) const { return std::stod(text(column)); }

 private:
  std::map<std::string, std::string> cells_;
};

/// The rows of tests/terramech/reference/NAME.csv. Throws std::runtime_error if the file has none.
std::vector<ReferenceRow> referenceTable(const std::string& name);

}  // namespace talus::terramech::test
