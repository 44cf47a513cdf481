#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/common/limits.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/common/parallel_for.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
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
  addOption(command, "--column KNOWN=NAME[:UNIT]", options.columns);
  addOption(command, "--columns FILE", options.columns_file);
  addOption(command, "--radius M", options.radius_m)->check(within(1e-3, 10.0));
  addOption(command, "--width M", options.width_m)->check(within(1e-3, 10.0));
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
      boost::trim(line);
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
    context.warn(fmt::format("{}: {} more rows rejected", path, rows.size() - kShown));
}

nlohmann::ordered_json rejectedJson(const std::vector<terramech::RejectedRow>& rows) {
  return jsonList(rows, [](const terramech::RejectedRow& row) -> nlohmann::ordered_json {
    return {{"line", row.line}, {"reason", row.reason}};
  });
}

namespace {

using terramech::CsvReader;
using terramech::CsvRow;
using terramech::WheelCase;
using terramech::WheelForces;

struct InputColumn {
  const char* name;
  double WheelCase::*field;
  bool optional = false;
};

constexpr InputColumn kInputs[] = {{"cohesion_Pa", &WheelCase::cohesion_Pa},
                                   {"friction_angle_rad", &WheelCase::friction_angle_rad},
                                   {"sinkage_exponent", &WheelCase::sinkage_exponent},
                                   {"sinkage_modulus", &WheelCase::sinkage_modulus},
                                   {"shear_modulus_m", &WheelCase::shear_modulus_m},
                                   {"c1", &WheelCase::c1, true},
                                   {"c2", &WheelCase::c2, true},
                                   {"wheel_radius_m", &WheelCase::wheel_radius_m},
                                   {"wheel_width_m", &WheelCase::wheel_width_m},
                                   {"load_N", &WheelCase::load_N},
                                   {"slip", &WheelCase::slip},
                                   {"slip_angle_rad", &WheelCase::slip_angle_rad, true},
                                   {"density_kg_m3", &WheelCase::density_kg_m3, true},
                                   {"gravity_m_s2", &WheelCase::gravity_m_s2, true},
                                   {"digging_exponent", &WheelCase::digging_exponent, true},
                                   {"side_bulldozing", &WheelCase::side_bulldozing, true},
                                   {"slip_sinkage_exponent", &WheelCase::slip_sinkage_exponent, true}};

constexpr std::pair<const char*, double WheelForces::*> kResults[] = {
    {"sinkage_m", &WheelForces::sinkage_m},
    {"entry_angle_rad", &WheelForces::entry_angle_rad},
    {"torque_Nm", &WheelForces::torque_Nm},
    {"drawbar_pull_N", &WheelForces::drawbar_pull_N},
    {"side_force_N", &WheelForces::side_force_N}};

// Weight of a thousand tonnes: larger loads indicate wrong units, and the equilibrium search takes long to
// fail.
constexpr double kHeaviest_N = 1e7;

bool isResult(const std::string& name) {
  return std::ranges::any_of(kResults, [&](const auto& result) { return name == result.first; });
}

/// Returns the column index of each input; empty for a missing optional input.
std::vector<std::optional<std::size_t>> positions(const CsvReader& reader, const std::string& path) {
  terramech::checkColumnUnits(reader.header(), wheelCaseColumns(), path);
  std::vector<std::optional<std::size_t>> at;
  std::string missing;
  for (const InputColumn& input : kInputs) {
    const auto found = std::ranges::find(reader.header(), input.name);
    at.emplace_back();
    if (found != reader.header().end())
      at.back() = static_cast<std::size_t>(found - reader.header().begin());
    else if (!input.optional)
      missing += (missing.empty() ? "" : ", ") + std::string(input.name);
  }
  if (missing.empty()) return at;
  throw InputError({path + ":1", "no column " + missing, "add it to the header row, in SI units"});
}

/// A row and its case; `fault` is the reason if the row contains no valid case.
struct Entry {
  CsvRow row;
  WheelCase wheel_case;
  std::string fault;
};

Entry entryOf(CsvRow row, const std::vector<std::optional<std::size_t>>& at) {
  Entry entry{std::move(row), {}, {}};
  entry.fault = entry.row.fault;
  for (std::size_t k = 0; k < at.size() && entry.fault.empty(); ++k) {
    if (!at[k]) continue;
    const std::string& field = entry.row.fields[*at[k]];
    if (!terramech::parseNumber(field, entry.wheel_case.*kInputs[k].field))
      entry.fault = fmt::format("{} = '{}', must be a number", kInputs[k].name, field);
    else if (std::isfinite(entry.wheel_case.*kInputs[k].field) &&
             !plausible(entry.wheel_case.*kInputs[k].field))
      entry.fault = fmt::format("{} = {}, {}", kInputs[k].name, field, kPlausible);
    else if (kInputs[k].field == &WheelCase::load_N && entry.wheel_case.load_N > kHeaviest_N)
      entry.fault = fmt::format("load_N = {}, must be at most {:g}", field, kHeaviest_N);
  }
  return entry;
}

std::string reasonOf(const WheelCase& wheel_case) {
  try {
    static_cast<void>(terramech::equilibrium(wheel_case));
  } catch (const std::exception& e) {
    return e.what();
  }
  return "has no equilibrium";
}

class Writer {
 public:
  /// Side forces, the last of the results, are written only if the table has a slip angle column.
  Writer(const std::filesystem::path& path, const std::vector<std::string>& header)
      : file_(path),
        header_(header),
        results_(kResults, std::size(kResults) - (std::ranges::count(header, "slip_angle_rad") > 0 ? 0 : 1)) {
    writeKept(header);
    for (const auto& [name, field] : results_) out_ << ',' << name;
    out_ << '\n';
  }

  void write(const Entry& entry, const WheelForces* forces) {
    writeKept(entry.row.fields);
    for (const auto& [name, field] : results_)
      out_ << ',' << (forces ? fmt::format("{}", forces->*field) : "");
    out_ << '\n';
  }

  void commit() { file_.commit(); }

 private:
  void writeKept(const std::vector<std::string>& fields) {
    bool first = true;
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (isResult(header_[k])) continue;
      if (!first) out_ << ',';
      first = false;
      if (k < fields.size()) out_ << terramech::csvField(fields[k]);
    }
  }

  OutputFile file_;
  std::vector<std::string> header_;
  std::span<const std::pair<const char*, double WheelForces::*>> results_;
  std::ostream& out_ = file_.stream();
};

std::vector<WheelForces> solved(const std::vector<Entry>& entries, int threads) {
  std::vector<WheelCase> cases(entries.size());
  std::ranges::transform(entries, cases.begin(), &Entry::wheel_case);
  std::vector<WheelForces> forces(cases.size());
  // Blocks of a multiple of four cases: the SIMD lane of a case, and thus its result, is independent of the
  // number of threads.
  constexpr std::size_t kBlock = 256;
  parallelFor((cases.size() + kBlock - 1) / kBlock, threads, [&](std::size_t k) {
    const std::size_t first = k * kBlock, count = std::min(kBlock, cases.size() - first);
    const auto part = [&](auto& all) { return std::span(all).subspan(first, count); };
    terramech::equilibria(part(cases), part(forces));
  });
  return forces;
}

void writeBlock(const std::vector<Entry>& entries, const std::vector<WheelForces>& forces, Writer& writer,
                WheelCaseTable& table) {
  for (std::size_t k = 0; k < entries.size(); ++k) {
    std::string fault = entries[k].fault;
    if (fault.empty() && std::isnan(forces[k].sinkage_m)) fault = reasonOf(entries[k].wheel_case);
    writer.write(entries[k], fault.empty() ? &forces[k] : nullptr);
    if (fault.empty())
      ++table.solved;
    else
      table.refused.push_back({entries[k].row.line, fault});
  }
}

void checkSolved(const WheelCaseTable& table, const std::string& path) {
  if (table.solved > 0) return;
  if (table.refused.empty()) throw InputError({path, "no rows after the header", "add rows"});
  throw InputError({path + ":" + std::to_string(table.refused.front().line),
                    "no row can be solved; first reason: " + table.refused.front().reason,
                    "correct the rows"});
}

}  // namespace

std::vector<std::string> wheelCaseColumns() {
  std::vector<std::string> names;
  for (const InputColumn& input : kInputs) names.emplace_back(input.name);
  return names;
}

WheelCaseTable solveWheelTable(const terramech::TableFile& input, const std::filesystem::path& output,
                               int threads, const ProgressMonitor& watch) {
  constexpr std::size_t kBlock = 16384;
  CsvReader reader{input};
  const auto at = positions(reader, input.path);
  Writer writer{output, reader.header()};
  WheelCaseTable table;
  table.replaced = std::any_of(reader.header().begin(), reader.header().end(), isResult);
  std::vector<Entry> entries;
  for (bool more = true; more;) {
    CsvRow row;
    while (entries.size() < kBlock && (more = reader.next(row)))
      entries.push_back(entryOf(std::move(row), at));
    writeBlock(entries, solved(entries, threads), writer, table);
    entries.clear();
    if (watch.stopped()) throw std::runtime_error("cancelled");
    watch.report(reader.fraction());
  }
  checkSolved(table, input.path);
  writer.commit();
  return table;
}

}  // namespace talus::cli
