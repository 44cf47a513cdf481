#include "reference_table.hpp"

#include <fstream>
#include <stdexcept>
#include <utility>

namespace talus::terramech::test {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  for (std::size_t comma; (comma = line.find(',', from)) != std::string::npos; from = comma + 1)
    cells.push_back(line.substr(from, comma - from));
  cells.push_back(line.substr(from));
  return cells;
}

}  // namespace

ReferenceRow::ReferenceRow(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}

std::vector<ReferenceRow> referenceTable(const std::string& name) {
  std::ifstream file(TALUS_REFERENCE_TABLES "/" + name + ".csv");
  std::string line;
  std::getline(file, line);
  const auto columns = cellsOf(line);
  std::vector<ReferenceRow> rows;
  while (std::getline(file, line)) {
    const auto cells = cellsOf(line);
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < columns.size(); ++k) row[columns[k]] = cells.at(k);
    rows.emplace_back(std::move(row));
  }
  if (rows.empty()) throw std::runtime_error("no reference table '" + name + "'");
  return rows;
}

}  // namespace talus::terramech::test
