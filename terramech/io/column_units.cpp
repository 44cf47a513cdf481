#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <talus/common/input_error.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/unit.hpp>

namespace talus::terramech {
namespace {

enum class Kind { Length, Force, Torque, Pressure, Angle, Time, Speed, Rate, Share };

/// Unit as written in a suffix.
struct SuffixUnit {
  std::string_view name;
  Kind kind;
};

// Units that also occur with an SI prefix. A load in kilograms is converted to a force.
constexpr SuffixUnit kBase[] = {{"m", Kind::Length},  {"N", Kind::Force},     {"g", Kind::Force},
                                {"Nm", Kind::Torque}, {"N_m", Kind::Torque},  {"s", Kind::Time},
                                {"rad", Kind::Angle}, {"Pa", Kind::Pressure}, {"mps", Kind::Speed},
                                {"m_s", Kind::Speed}, {"radps", Kind::Rate},  {"rad_s", Kind::Rate}};
constexpr std::string_view kPrefixes[] = {"", "n", "u", "m", "c", "d", "h", "k", "M", "G"};

constexpr SuffixUnit kOther[] = {
    {"metre", Kind::Length},      {"meter", Kind::Length},      {"millimetre", Kind::Length},
    {"millimeter", Kind::Length}, {"centimetre", Kind::Length}, {"centimeter", Kind::Length},
    {"kilometre", Kind::Length},  {"kilometer", Kind::Length},  {"inch", Kind::Length},
    {"inches", Kind::Length},     {"ft", Kind::Length},         {"feet", Kind::Length},
    {"newton", Kind::Force},      {"t", Kind::Force},           {"kgf", Kind::Force},
    {"gf", Kind::Force},          {"lb", Kind::Force},          {"lbs", Kind::Force},
    {"lbf", Kind::Force},         {"tonne", Kind::Force},       {"lbft", Kind::Torque},
    {"ftlb", Kind::Torque},       {"lb_ft", Kind::Torque},      {"ft_lb", Kind::Torque},
    {"kgm", Kind::Torque},        {"kgcm", Kind::Torque},       {"kgfm", Kind::Torque},
    {"kgfcm", Kind::Torque},      {"psi", Kind::Pressure},      {"ncm", Kind::Torque},
    {"nmm", Kind::Torque},        {"radian", Kind::Angle},      {"deg", Kind::Angle},
    {"degree", Kind::Angle},      {"gon", Kind::Angle},         {"second", Kind::Time},
    {"min", Kind::Time},          {"minute", Kind::Time},       {"h", Kind::Time},
    {"hour", Kind::Time},         {"kmh", Kind::Speed},         {"km_h", Kind::Speed},
    {"kmph", Kind::Speed},        {"kph", Kind::Speed},         {"mph", Kind::Speed},
    {"fps", Kind::Speed},         {"ft_s", Kind::Speed},        {"rpm", Kind::Rate},
    {"deg_s", Kind::Rate},        {"degps", Kind::Rate},        {"percent", Kind::Share},
    {"percentage", Kind::Share},  {"pct", Kind::Share},         {"permille", Kind::Share},
    {"promille", Kind::Share}};

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// Returns the kind of a unit, ignoring case; empty if the text is not a unit.
std::optional<Kind> kindOf(std::string_view text) {
  const std::string small = lower(text);
  for (const SuffixUnit& unit : kOther)
    if (small == unit.name || small == std::string(unit.name) + "s") return unit.kind;
  for (const SuffixUnit& unit : kBase)
    for (const std::string_view prefix : kPrefixes)
      if (small == lower(std::string(prefix) + std::string(unit.name))) return unit.kind;
  return std::nullopt;
}

/// Returns the name with separators replaced by `_` and the signs % and degree by words: "load [N]" becomes
/// "load_N".
std::string plain(std::string_view name) {
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
  std::string once;
  for (const char c : text)
    if (c != '_' || (!once.empty() && once.back() != '_')) once += c;
  if (once.ends_with('_')) once.pop_back();
  return once;
}

/// Known column, split into stem and unit.
struct KnownColumn {
  explicit KnownColumn(const std::string& whole)
      : name(whole),
        unit(unitOf(whole)),
        stem(unit.empty() ? whole : whole.substr(0, whole.size() - unit.size() - 1)) {}

  std::string name, unit, stem;

  /// Returns true if a column with another unit of this kind has the quantity of this column.
  bool takes(std::string_view other, std::optional<Kind> kind) const {
    const auto own = unit.empty() ? Kind::Share : kindOf(unit);
    return (kind && kind == own) || conversion(other, unit) ||
           (kind == Kind::Share && own == Kind::Angle);  // slope in percent
  }
};

// True if a suffix may be an index or a word, as in slip_t and speed_min.
bool mayBeNoUnit(std::string_view suffix) {
  return suffix.size() < 2 || suffix == "min";
}

/// Returns why an unknown name is probably this known column; empty if the name is accepted as an unknown
/// column.
std::string faultOf(const std::string& name, const KnownColumn& column) {
  const std::string text = plain(name);
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
  // A single letter in front of a suffix may be an axis of any quantity.
  if (!kind || mayBeNoUnit(suffix) || stem.size() < 2) return {};
  return "has a unit of another kind than the known column";
}

std::string remedyFor(const std::string& name, const KnownColumn& column) {
  std::string how = column.unit.empty() ? ", a number without a unit" : ", in " + column.unit;
  if (!column.unit.empty())
    if (const auto factor = conversion(unitOf(name), column.unit); factor && *factor != 1.0)
      how += fmt::format(" ({} times {:.10g})", name, *factor);
  return fmt::format("write column {}{}; or rename {} if it is another quantity", column.name, how, name);
}

}  // namespace

void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file) {
  const auto contains = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const std::string& name : header) {
    if (name.empty() || contains(known, name)) continue;
    for (const std::string& other : known) {
      if (contains(header, other)) continue;
      const KnownColumn column(other);
      const std::string fault = faultOf(name, column);
      if (fault.empty()) continue;
      throw InputError({.where = file + ":1",
                        .reason = fmt::format("column {} {}", name, fault),
                        .remedy = remedyFor(name, column)});
    }
  }
}

}  // namespace talus::terramech
