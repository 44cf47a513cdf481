#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/field_text.hpp>
#include <talus/terramech/io/table_columns.hpp>

namespace talus::terramech {
namespace {

// Common symbols of known columns.
constexpr std::pair<std::string_view, const char*> kSymbols[] = {
    {"Fz", "load_N"},       {"Fn", "load_N"},    {"Fx", "drawbar_pull_N"}, {"DP", "drawbar_pull_N"},
    {"Fy", "side_force_N"}, {"Mx", "torque_Nm"}, {"My", "torque_Nm"},      {"Mt", "torque_Nm"}};

// Replaces a decimal comma: "1,5" becomes "1.5". Used if commas are not separators.
void withPoint(std::string& field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string::npos || field.find(',', comma + 1) != std::string::npos) return;
  std::string pointed = field;
  pointed[comma] = '.';
  if (double value = 0.0; field.find('.') == std::string::npos && parseNumber(pointed, value))
    field = pointed;
}

}  // namespace

std::optional<double> columnFactor(const std::string& unit, const std::string& known) {
  const std::string_view own = unitOf(known);
  if (unit == own || (own.empty() && unit == "ratio")) return 1.0;
  if (!own.empty()) return conversion(unit, own);
  const auto percent = conversion(unit, "percent");
  return percent ? std::optional(0.01 * *percent) : std::nullopt;
}

TableColumns::TableColumns(std::vector<std::string> header, const TableFile& table, bool decimal_commas)
    : header_(std::move(header)), own_(header_.size()), decimal_commas_(decimal_commas) {
  for (const MappedColumn& mapped : table.columns) map(mapped, table);
  if (table.note) {
    convertUnits(table);
    nameLookalikes(table);
  }
  for (const auto& [name, value] : table.constants) {
    if (has(name))
      throw InputError(
          {table.path + ":1", "has column " + name + ", which is also given by an option", "remove one"});
    header_.push_back(name);
    constants_.push_back(fmt::format("{}", value));
  }
}

bool TableColumns::has(const std::string& name) const {
  return std::ranges::find(header_, name) != header_.end();
}

void TableColumns::map(const MappedColumn& mapped, const TableFile& table) {
  const std::string asked = fmt::format("--column {}={}", mapped.known, mapped.name);
  const auto column = std::ranges::find(header_, mapped.name);
  if (column == header_.end()) {
    const std::string near = nearestName(mapped.name, header_);
    throw InputError({table.path + ":1",
                      fmt::format("no column {} ({}), or it is mapped twice", mapped.name, asked),
                      near.empty() ? "name a column of its header" : "the nearest is '" + near + "'"});
  }
  if (mapped.name != mapped.known && has(mapped.known))
    throw InputError(
        {table.path + ":1", fmt::format("has column {} already ({})", mapped.known, asked), "remove one"});
  const std::string suffix(unitOf(mapped.name));
  const std::string unit = !mapped.unit.empty() ? mapped.unit
                           : columnFactor(suffix, mapped.known).has_value()
                               ? suffix
                               : std::string(unitOf(mapped.known));
  const auto factor = columnFactor(unit, mapped.known);
  if (!factor) {
    const std::string units = unitsLike(unitOf(mapped.known));
    throw InputError({table.path + ":1", fmt::format("{}: '{}' is no unit of {}", asked, unit, mapped.known),
                      "its units are " + (units.empty() ? "ratio and percent" : units)});
  }
  *column = mapped.known;
  if (*factor != 1.0) conversions_.push_back({static_cast<std::size_t>(column - header_.begin()), *factor});
  if (table.note)
    table.note(fmt::format("column {} is read as {}{}", mapped.name, mapped.known,
                           *factor == 1.0 ? "" : fmt::format(", times {:g}", *factor)));
}

// Converts columns such as `sinkage_mm`, whose unit is explicit.
void TableColumns::convertUnits(const TableFile& table) {
  std::vector<std::string> all = knownTelemetryColumns();
  all.insert(all.end(), table.also.begin(), table.also.end());
  for (const std::string& known : all) {
    if (has(known) || stemOf(known).size() < 2) continue;  // a single letter, as in z_mm, may be any quantity
    for (const std::string& name : std::vector<std::string>(header_)) {
      if (name.empty() || has(known) || stemOf(name) != stemOf(known) || unitOf(name).empty()) continue;
      if (columnFactor(std::string(unitOf(name)), known)) map({.known = known, .name = name}, table);
    }
  }
}

void TableColumns::nameLookalikes(const TableFile& table) const {
  for (const auto& [symbol, known] : kSymbols)
    if (has(std::string(symbol)) && !has(known))
      table.note(fmt::format(
          "column {0} is kept as a column of your own; if it is {1}, pass --column {1}={0}", symbol, known));
}

void TableColumns::apply(std::vector<std::string>& fields, bool whole) const {
  if (decimal_commas_)
    for (std::string& field : fields) withPoint(field);
  // A cell "5%" of a quantity without unit is a fraction, also in a column that is converted from percent.
  for (std::size_t k = 0; k < std::min(own_, fields.size()); ++k)
    if (double value = 0.0; fields[k].ends_with('%') && unitOf(header_[k]).empty() &&
                            parseNumber(fields[k].substr(0, fields[k].size() - 1), value))
      fields[k] = fmt::format(
          "{}", std::ranges::count(conversions_, k, &Conversion::column) > 0 ? value : 0.01 * value);
  for (const Conversion& c : conversions_)
    if (double value = 0.0; c.column < fields.size() && parseNumber(fields[c.column], value))
      fields[c.column] = fmt::format("{}", value * c.factor);
  if (constants_.empty()) return;
  if (whole) fields.resize(own_);
  fields.insert(fields.end(), constants_.begin(), constants_.end());
}

}  // namespace talus::terramech
