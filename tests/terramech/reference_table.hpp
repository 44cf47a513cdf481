#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace talus::terramech::test {

using Row = std::map<std::string, double>;

/// Folder of the reference values, empty when TALUS_REFERENCE is not set.
inline std::string referenceFolder() {
  const char* folder = std::getenv("TALUS_REFERENCE");
  return folder ? folder : "";
}

/// A plain numeric CSV with a header.
inline std::vector<Row> readTable(const std::string& path) {
  std::ifstream file(path);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::stringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) {
      if (cell.ends_with('\r')) cell.pop_back();
      out.push_back(cell);
    }
    return out;
  };
  std::string line;
  std::getline(file, line);
  const auto names = cells(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const auto values = cells(line);
    Row row;
    for (std::size_t k = 0; k < names.size() && k < values.size(); ++k) row[names[k]] = std::stod(values[k]);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace talus::terramech::test
