#include <algorithm>
#include <fstream>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {
namespace {

using terramech::MappedColumn;

MappedColumn parsed(const std::string& word, const std::string& where,
                    const std::vector<std::string>& known) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == word.size())
    throw InputError(
        {where, "'" + word + "' is not KNOWN=NAME[:UNIT]", "write load_N=Fz or slip=slip_pct:percent"});
  MappedColumn column{.known = word.substr(0, equals), .name = word.substr(equals + 1)};
  if (std::ranges::find(known, column.known) == known.end()) {
    const std::string near = terramech::meantKey(column.known, known);
    throw InputError({where, "'" + column.known + "' is no column that is read",
                      near.empty() ? "talus help formats lists them" : "did you mean " + near + "?"});
  }
  if (const std::size_t colon = column.name.rfind(':'); colon != std::string::npos && colon > 0) {
    column.unit = column.name.substr(colon + 1);
    column.name.resize(colon);
  }
  return column;
}

void requireOnce(const std::vector<MappedColumn>& columns, const std::string& where) {
  for (auto later = columns.begin(); later != columns.end(); ++later)
    for (auto earlier = columns.begin(); earlier != later; ++earlier)
      if (later->known == earlier->known || later->name == earlier->name)
        throw InputError({where,
                          fmt::format("{} is mapped twice ({}={} and {}={})",
                                      later->known == earlier->known ? later->known : later->name,
                                      earlier->known, earlier->name, later->known, later->name),
                          "remove one"});
}

}  // namespace

void addTableOptions(CLI::App& command, TableOptions& options) {
  command
      .add_option("--column", options.columns,
                  "read a column of the file under another name, in another unit (load_N=Fz, "
                  "slip=slip_pct:percent); may be repeated")
      ->type_name("KNOWN=NAME[:UNIT]");
  command
      .add_option("--columns", options.columns_file,
                  "file with a line each as --column takes it, # for remarks")
      ->type_name("FILE");
  command.add_option("--radius", options.radius_m, "wheel radius of every row, in metres")
      ->check(within(1e-3, 10.0))
      ->type_name("M");
  command.add_option("--width", options.width_m, "wheel width of every row, in metres")
      ->check(within(1e-3, 10.0))
      ->type_name("M");
  groupOptions(command, "Columns of the table");
}

terramech::TableFile tableFile(const std::string& path, const TableOptions& options, const Context& context,
                               const std::vector<std::string>& also) {
  terramech::TableFile table(path);
  table.also = also;
  std::vector<std::string> known = terramech::namesOf(terramech::telemetryKeys());
  known.insert(known.end(), also.begin(), also.end());
  if (!options.columns_file.empty()) {
    checkInput(options.columns_file);
    std::ifstream file(options.columns_file);
    if (!file) throw InputError({options.columns_file, "cannot be opened", "check the path"});
    std::size_t number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      line.resize(std::min(line.size(), line.find('#')));
      line.erase(line.find_last_not_of(" \t\r") + 1);
      line.erase(0, std::min(line.size(), line.find_first_not_of(" \t")));
      if (!line.empty())
        table.columns.push_back(parsed(line, fmt::format("{}:{}", options.columns_file, number), known));
    }
  }
  for (const std::string& word : options.columns) table.columns.push_back(parsed(word, "--column", known));
  requireOnce(table.columns, options.columns.empty() ? options.columns_file : "--column");
  if (options.radius_m > 0.0) table.constants.emplace_back("wheel_radius_m", options.radius_m);
  if (options.width_m > 0.0) table.constants.emplace_back("wheel_width_m", options.width_m);
  table.note = [&context, path,
                printed = std::make_shared<std::set<std::string>>()](const std::string& text) {
    if (printed->insert(text).second) context.warn(path + ": " + text);
  };
  return table;
}

void warnOfRejected(const std::vector<terramech::RejectedRow>& rows, const std::string& path,
                    const Context& context) {
  constexpr std::size_t kShown = 20;
  for (std::size_t k = 0; k < rows.size() && k < kShown; ++k)
    context.warn(fmt::format("{}:{}: {}", path, rows[k].line, rows[k].reason));
  if (rows.size() > kShown)
    context.warn(fmt::format("{}: {} more rows rejected; --json lists all", path, rows.size() - kShown));
}

nlohmann::ordered_json rejectedJson(const std::vector<terramech::RejectedRow>& rows) {
  auto all = nlohmann::ordered_json::array();
  for (const auto& row : rows) all.push_back({{"line", row.line}, {"reason", row.reason}});
  return all;
}

}  // namespace talus::cli
