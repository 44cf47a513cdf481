#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/field_text.hpp>

namespace talus::terramech {
namespace {

/// Unit, its kind, and the factor to the SI unit of the kind.
struct Unit {
  std::string_view name;
  char kind;
  double factor;
};

constexpr Unit kUnits[] = {
    {"rad", 'a', 1.0},      {"deg", 'a', kDegree},                                            // angle
    {"Pa", 'p', 1.0},       {"hPa", 'p', 1e2},       {"kPa", 'p', 1e3},   {"MPa", 'p', 1e6},  // pressure
    {"N", 'f', 1.0},        {"mN", 'f', 1e-3},       {"kN", 'f', 1e3},                        // force
    {"m", 'l', 1.0},        {"mm", 'l', 1e-3},       {"cm", 'l', 1e-2},   {"dm", 'l', 0.1},
    {"km", 'l', 1e3},       {"Nm", 't', 1.0},        {"mNm", 't', 1e-3},  {"Ncm", 't', 1e-2},
    {"kNm", 't', 1e3},                                                                               // torque
    {"mps", 'v', 1.0},      {"mmps", 'v', 1e-3},     {"cmps", 'v', 1e-2}, {"kmph", 'v', 1.0 / 3.6},  // speed
    {"m_s", 'v', 1.0},      {"mm_s", 'v', 1e-3},     {"cm_s", 'v', 1e-2}, {"km_h", 'v', 1.0 / 3.6},
    {"kg", 'm', 1.0},       {"g", 'm', 1e-3},        {"t", 'm', 1e3},  // mass
    {"s", 's', 1.0},        {"ms", 's', 1e-3},       {"us", 's', 1e-6},   {"ns", 's', 1e-9},
    {"min", 's', 60.0},     {"h", 's', 3600.0},                                                 // time
    {"W", 'w', 1.0},        {"mW", 'w', 1e-3},       {"kW", 'w', 1e3},                          // power
    {"J", 'e', 1.0},        {"kJ", 'e', 1e3},        {"MJ", 'e', 1e6},    {"Wh", 'e', 3600.0},  // energy
    {"m_s2", 'g', 1.0},     {"g0", 'g', 9.80665},                         // acceleration
    {"kg_m3", 'd', 1.0},    {"g_cm3", 'd', 1e3},     {"t_m3", 'd', 1e3},  // density
    {"rad_s", 'o', 1.0},    {"deg_s", 'o', kDegree},                      // turning rate
    {"percent", '1', 0.01}, {"pct", '1', 0.01},      {"%", '1', 0.01},    {"permille", '1', 0.001},  // share
};

const Unit* find(std::string_view name) {
  for (const Unit& unit : kUnits)
    if (unit.name == name) return &unit;
  return nullptr;
}

}  // namespace

std::optional<double> conversion(std::string_view from, std::string_view to) {
  const Unit *a = find(from), *b = find(to);
  if (!a || !b || a->kind != b->kind) return std::nullopt;
  return a->factor / b->factor;
}

std::string unitsLike(std::string_view unit) {
  std::string names;
  if (const Unit* known = find(unit))
    for (const Unit& one : kUnits)
      if (one.kind == known->kind) names += (names.empty() ? "" : ", ") + std::string(one.name);
  return names;
}

std::string_view unitOf(std::string_view name) {
  std::string_view longest;
  for (const Unit& unit : kUnits) {
    const std::size_t n = unit.name.size();
    if (name.size() > n + 1 && name.ends_with(unit.name) && name[name.size() - n - 1] == '_' &&
        n > longest.size())
      longest = unit.name;
  }
  return longest;
}

std::string stemOf(std::string_view name) {
  const std::string_view unit = unitOf(name);
  return std::string(unit.empty() ? name : name.substr(0, name.size() - unit.size() - 1));
}

namespace {

enum class Kind { Length, Force, Torque, Pressure, Angle, Time, Speed, Rate, Share };

// Units that also occur with an SI prefix. A load in kilograms is converted to a force.
constexpr std::pair<std::string_view, Kind> kBase[] = {
    {"m", Kind::Length},   {"N", Kind::Force},   {"g", Kind::Force},    {"Nm", Kind::Torque},
    {"N_m", Kind::Torque}, {"s", Kind::Time},    {"rad", Kind::Angle},  {"Pa", Kind::Pressure},
    {"mps", Kind::Speed},  {"m_s", Kind::Speed}, {"radps", Kind::Rate}, {"rad_s", Kind::Rate}};
constexpr std::string_view kPrefixes[] = {"", "n", "u", "m", "c", "d", "h", "k", "M", "G"};

// Other units of each kind, each between blanks.
constexpr std::pair<std::string_view, Kind> kOther[] = {
    {" metre meter millimetre millimeter centimetre centimeter kilometre kilometer inch inches ft feet ",
     Kind::Length},
    {" newton t kgf gf lb lbs lbf tonne ", Kind::Force},
    {" lbft ftlb lb_ft ft_lb kgm kgcm kgfm kgfcm ncm nmm ", Kind::Torque},
    {" psi ", Kind::Pressure},
    {" radian deg degree gon ", Kind::Angle},
    {" second min minute h hour ", Kind::Time},
    {" kmh km_h kmph kph mph fps ft_s ", Kind::Speed},
    {" rpm deg_s degps ", Kind::Rate},
    {" percent percentage pct permille promille ", Kind::Share}};

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// Returns the kind of a unit, ignoring case; empty if the text is not a unit.
std::optional<Kind> kindOf(std::string_view text) {
  const std::string small = lower(text);
  for (const auto& [units, kind] : kOther)
    for (const std::string& one : {small, small.substr(0, small.size() - (small.ends_with('s') ? 1 : 0))})
      if (units.find(" " + one + " ") != units.npos) return kind;
  for (const auto& [unit, kind] : kBase)
    for (const std::string_view prefix : kPrefixes)
      if (small == lower(std::string(prefix) + std::string(unit))) return kind;
  return std::nullopt;
}

/// Known column, split into stem and unit.
struct KnownColumn {
  std::string name, unit{unitOf(name)}, stem{stemOf(name)};

  /// Returns true if a column with another unit of this kind has the quantity of this column.
  bool takes(std::string_view other, std::optional<Kind> kind) const {
    const auto own = unit.empty() ? Kind::Share : kindOf(unit);
    return (kind && kind == own) || conversion(other, unit) ||
           (kind == Kind::Share && own == Kind::Angle);  // slope in percent
  }
};

/// Returns why an unknown name is probably this known column; empty if the name is accepted as an unknown
/// column.
std::string faultOf(const std::string& name, const KnownColumn& column) {
  const std::string text = plainName(name);
  const std::string small = lower(text), stem = lower(column.stem);
  if (small == lower(column.name)) return "resembles a known column";
  // `time` without unit may be a date, and a single letter may be an axis.
  const bool of_time = kindOf(column.unit) == Kind::Time;
  if (small == stem) return of_time || stem.size() < 2 ? "" : "names no unit";
  if (!small.starts_with(stem + '_'))  // one typing error per 8 letters: drawbar_pul_N
    return 8 * editDistance(small, lower(column.name)) <= small.size() + 1 ? "resembles a known column" : "";
  const std::string_view suffix = std::string_view(text).substr(stem.size() + 1);
  const auto kind = kindOf(suffix);
  if (column.takes(suffix, kind)) return "has another unit than the known column";
  // A suffix may be an index or a word, as in slip_t and speed_min; a single letter in front an axis of any quantity.
  if (!kind || suffix.size() < 2 || suffix == "min" || stem.size() < 2) return {};
  return "has a unit of another kind than the known column";
}

std::string remedyFor(const std::string& name, const KnownColumn& column) {
  if (column.unit.empty() && plainName(name) == column.stem + "_percent")
    return fmt::format("pass --column '{}={}:percent'", column.name, name);
  std::string how = column.unit.empty() ? ", a number without a unit" : ", in " + column.unit;
  if (!column.unit.empty())
    if (const auto factor = conversion(unitOf(name), column.unit); factor && *factor != 1.0)
      how += fmt::format(" ({} times {:.10g})", name, *factor);
  return fmt::format("write column {}{}; or rename {} if it is another quantity", column.name, how, name);
}

}  // namespace

std::string plainName(std::string_view name) {
  constexpr std::string_view kDegreeSign = "\xC2\xB0", kParting = " -.,:;/()[]{}\t";
  std::string text;
  for (std::size_t k = 0; k < name.size(); ++k) {
    if (name.substr(k).starts_with(kDegreeSign)) {
      text += "_deg_";
      k += kDegreeSign.size() - 1;
    } else if (name[k] == '%') {
      text += "_percent_";
    } else {
      text += kParting.find(name[k]) == std::string_view::npos ? name[k] : '_';
    }
  }
  text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == '_' && b == '_'; }),
             text.end());
  if (text.ends_with('_')) text.pop_back();
  return text.starts_with('_') ? text.substr(1) : text;
}

bool takeUnits(std::vector<std::string>& header, const std::vector<std::string>& row,
               const std::string& file) {
  std::vector<std::string> names = header;
  bool any = false;
  for (std::size_t k = 0; k < row.size(); ++k) {
    if (double value = 0.0; parseNumber(row[k], value) || row.size() != header.size()) return false;
    std::string unit = plainName(row[k]);
    std::erase_if(unit, [&](char c) { return c == '_' && unit.starts_with('N'); });  // N m
    if (find(unit) == nullptr) continue;
    any = true;
    if (const std::string_view own = unitOf(names[k]); own.empty() && !names[k].ends_with("_" + unit))
      names[k] += '_' + unit;
    else if (!own.empty() && own != unit)
      throw InputError(
          {file + ":2", "column " + names[k] + " is in " + unit, "correct its name or its unit"});
  }
  if (any) header = names;
  return any;
}

void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file) {
  for (const std::string& name : header) {
    if (name.empty() || std::ranges::count(known, name) > 0) continue;
    for (const std::string& other : known) {
      if (std::ranges::count(header, other) > 0) continue;
      const KnownColumn column{other};
      const std::string fault = faultOf(name, column);
      if (fault.empty()) continue;
      throw InputError({.where = file + ":1",
                        .reason = fmt::format("column {} {}", name, fault),
                        .remedy = remedyFor(name, column)});
    }
  }
}

}  // namespace talus::terramech
