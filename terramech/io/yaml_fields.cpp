#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {

std::span<const FileKey> soilKeys() {
  static constexpr FileKey kKeys[] = {
      {"name", "of the soil; default unnamed"},
      {"cohesion_Pa", "0 to 1e9, required"},
      {"friction_angle_rad", "angle of internal friction, 0 to below a right angle, required"},
      {"sinkage_exponent", "n of Bekker's pressure-sinkage law, 0.001 to 100, required"},
      {"cohesive_modulus", "k_c in N/m^(n+1), default 0; one of the two moduli is required"},
      {"frictional_modulus", "k_phi in N/m^(n+2), default 0"},
      {"shear_modulus_m", "shear deformation modulus K, 1e-9 to 1000, required"},
      {"c1", "angle of the peak stress over the entry angle without slip, 0 to 1, default 0.43"},
      {"c2", "growth of c1 with slip, -1 to 1, default 0.32"},
      {"density_kg_m3", "bulk density, 0.1 to 1e6, default 1600"},
      {"slip_sinkage_exponent", "growth of the sinkage exponent with slip, 0 to 2, default 0"},
      {"digging_exponent", "growth of the sinkage exponent with sideways slip, 0 to 2, default 0.4"},
      {"side_bulldozing", "share of Hegedus' pressure on the side of a wheel, >= 0, default 1"},
      {"rut_stiffness", "stiffness in the rut of a wheel over that before, 1 to 1000, default 4"},
      {"test_gravity_m_s2",
       "gravity of the soil's test; in less, cohesion and moduli are less by as much; default 0: that of the "
       "rover"},
      {"correlation_time_s", "after which the strength is another, 0 to 1e12; default 0: it does not change"},
  };
  return kKeys;
}

std::span<const FileKey> roverKeys() {
  static constexpr FileKey kKeys[] = {
      {"name", "of the rover; default unnamed"},
      {"mass_kg", "0.1 to 1e6, required"},
      {"gravity_m_s2", "above 0, of the body that it drives on; default 9.80665"},
      {"wheels", "a mapping, see below, required"},
      {"wheelbase_m", "first to last axle, above 0, required"},
      {"track_m", "left to right wheel centres, above 0, required"},
      {"clearance_m", "ground to belly, above 0, required"},
      {"centre_of_mass_height_m", "above ground; default 0: unknown, no load moves on a slope"},
      {"centre_of_mass_ahead_m", "of the middle of the wheelbase, default 0"},
      {"centre_of_mass_left_m", "of the middle of the track, default 0"},
      {"max_pitch_rad", "greatest tilt along the heading, default 0.35"},
      {"max_roll_rad", "greatest tilt across the heading, default 0.35"},
      {"max_torque_Nm", "of each wheel, above 0, required"},
      {"max_speed_mps", "rim speed on level ground, 0.0001 to 100, default 0.05"},
      {"turning_radius_m", "0.001 to 1000; default 0: turns in place"},
      {"hotel_power_W", "consumed whether the rover drives or not, default 0"},
      {"steering", "skid (default), ackermann or all_wheel"},
  };
  return kKeys;
}

std::span<const FileKey> wheelKeys() {
  static constexpr FileKey kKeys[] = {
      {"count", "2 or more, required"},
      {"radius_m", "0.001 to 10, required"},
      {"width_m", "0.001 to 10, required"},
      {"grouser_height_m", "default 0: a smooth rim"},
      {"grouser_count", "default 0"},
      {"lug_thrust", "0 to 5, default 1 with lugs: share of Bekker's shear on their sides"},
  };
  return kKeys;
}

std::span<const FileKey> telemetryKeys() {
  static constexpr FileKey kKeys[] = {
      {"run", "word that joins the rows of one run"},
      {"wheel", "word or number of the wheel that a row is of"},
      {"pass_index", "1, 2, ...: number of the passage over the same ground"},
      {"time_s", "of the row; rows of one time are of one moment"},
      {"x_m", "place of the wheel or rover, in map metres"},
      {"y_m", "place of the wheel or rover, in map metres"},
      {"z_m", "elevation of the place"},
      {"heading_rad", "counter-clockwise from east"},
      {"pitch_rad", "of the body, positive uphill"},
      {"roll_rad", "of the body, -1.5 to 1.5"},
      {"slope_rad", "of the ground along the heading, positive uphill, -1.5 to 1.5"},
      {"slip", "1 - v/(r omega) driven, -1 to 1"},
      {"slip_angle_rad", "from the wheel's plane to the direction of travel, left positive, -1.6 to 1.6"},
      {"speed_mps", "of the wheel's centre"},
      {"rim_speed_mps", "radius times rotation rate"},
      {"load_N", "normal to the ground, above 0"},
      {"torque_Nm", "at the axle"},
      {"sinkage_m", "0 to below the wheel's diameter"},
      {"drawbar_pull_N", "net force along the wheel's plane"},
      {"side_force_N", "across the wheel's plane"},
      {"wheel_radius_m", "0.001 to 10; else that of the rover"},
      {"wheel_width_m", "0.001 to 10; else that of the rover"},
      {"grouser_height_m", "0 to 1"},
      {"grouser_count", "0 to 1000"},
      {"shear_modulus_m", "of the soil, where it is known"},
  };
  return kKeys;
}

std::vector<std::string> namesOf(std::span<const FileKey> keys) {
  std::vector<std::string> names;
  for (const FileKey& key : keys) names.emplace_back(key.name);
  return names;
}

std::string meantKey(const std::string& key, const std::vector<std::string>& known) {
  for (const std::string& name : known)
    if (stemOf(name) == key || stemOf(name) == stemOf(key)) return name;
  return nearestName(key, known);
}

std::string shortened(const std::string& word) {
  constexpr std::size_t kMost = 40;
  return word.size() <= kMost ? word : word.substr(0, kMost) + "...";
}

struct YamlFields::State {
  YAML::Node node;
  std::string origin;
  std::string what;  // "" at the root, otherwise the name of the mapping

  std::string where(int line) const { return line < 0 ? origin : origin + ":" + std::to_string(line + 1); }
};

namespace {

[[noreturn]] void fail(const std::string& where, const std::string& reason, const std::string& remedy) {
  throw InputError({.where = where, .reason = reason, .remedy = remedy});
}

/// Value of a field, and the factor from the unit in the file.
struct Found {  // NOLINT(bugprone-exception-escape): of YAML::Node
  YAML::Node value;
  double factor = 1.0;
};

double moduliFactor(std::string_view suffix) {
  for (const auto& [name, factor] :
       {std::pair{"_N", 1.0}, {"_kN", 1e3}, {"_MN", 1e6}, {"_Pa", 1.0}, {"_kPa", 1e3}, {"_MPa", 1e6}})
    if (suffix == name) return factor;
  return 0.0;
}

/// Returns the factor from the unit of a key in the file to that of a field; 0 if the key is another field.
double factorOf(const std::string& key, const std::string& name) {
  if (key == name) return 1.0;
  if (name.ends_with("_modulus"))
    return key.starts_with(name) ? moduliFactor(std::string_view(key).substr(name.size())) : 0.0;
  const std::string_view unit = unitOf(name), given = unitOf(key);
  if (unit.empty() || given.empty()) return 0.0;
  const auto stem = [](std::string_view text, std::string_view suffix) {
    return text.substr(0, text.size() - suffix.size());
  };
  if (stem(key, given) != stem(name, unit)) return 0.0;
  return conversion(given, unit).value_or(0.0);
}

// A yaml-cpp tree takes up to 360 bytes per byte of text ("{a},{a}"): 94 MB.
constexpr std::size_t kMostBytes = std::size_t{256} << 10U;

std::string kindOf(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  return node.IsNull() ? "empty" : "'" + shortened(node.Scalar()) + "'";
}

/// Returns a text value of the file. Throws InputError if it is empty or not UTF-8.
std::string wordOf(const YAML::Node& node, const std::string& where, const std::string& name) {
  const std::string& word = node.Scalar();
  if (!isText(word)) fail(where, name + " contains bytes that are not UTF-8", "save it as UTF-8");
  if (word.find_first_not_of(" \t\r\n") == std::string::npos)
    fail(where, name + " is empty", "leave it out or give a value");
  return word;
}

/// Lets YAML::Parser pass a document.
struct IgnoredEvents final : YAML::EventHandler {
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

}  // namespace

YamlFields YamlFields::of(const YAML::Node& node, const std::string& origin, const std::string& what) {
  auto state = std::make_shared<State>(State{node, origin, what});
  const std::string where = state->where(node.Mark().line);
  if (!node.IsMap())
    fail(where,
         what.empty()
             ? std::string("the file is ") + (node.IsSequence() ? "a list" : "a text") + ", no mapping"
             : what + " is " + kindOf(node),
         "write `name: value` lines");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) fail(where, "a name is " + kindOf(entry.first), "write `name: value` lines");
    wordOf(entry.first, state->where(entry.first.Mark().line), "a name");
    if (!seen.insert(entry.first.Scalar()).second)
      fail(state->where(entry.first.Mark().line), shortened(entry.first.Scalar()) + " appears twice",
           "remove one");
  }
  return YamlFields{state};
}

YamlFields YamlFields::file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail(path, "is a directory", "name a YAML file");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    fail(path, "is a device, a FIFO or a socket", "give a file");
  checkInput(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "cannot be read", "check the path and its permissions");
  std::string content;
  std::array<char, 65536> part{};
  while (content.size() <= kMostBytes && (in.read(part.data(), part.size()) || in.gcount() > 0))
    content.append(part.data(), static_cast<std::size_t>(in.gcount()));
  if (content.size() > kMostBytes)
    fail(path, "is larger than 256 kB, no description of a soil, rover, model or mission is",
         "name a YAML file");
  return text(content, path);
}

YamlFields YamlFields::text(const std::string& yaml, const std::string& origin) {
  if (const std::size_t nul = yaml.find('\0'); nul != std::string::npos)
    fail(origin + ":" +
             std::to_string(1 +
                            std::count(yaml.begin(), yaml.begin() + static_cast<std::ptrdiff_t>(nul), '\n')),
         "holds a NUL byte", "save it as UTF-8");
  try {
    const YAML::Node root = YAML::Load(yaml);
    if (root.IsNull()) fail(origin, "is empty", "write `name: value` lines");
    // Never YAML::LoadAll: on content that is not YAML, such as ",", it finds documents without end.
    std::istringstream in(yaml);
    YAML::Parser parser(in);
    IgnoredEvents events;
    if (parser.HandleNextDocument(events) && parser.HandleNextDocument(events))
      fail(origin, "holds more than one YAML document", "keep one of them");
    return of(root, origin, "");
  } catch (const YAML::Exception& e) {
    fail(origin + ":" + std::to_string(e.mark.line + 1), "not YAML: " + e.msg, "correct the syntax");
  }
}

namespace {

/// Returns the value of a field in any unit. Throws InputError if the field is given twice.
template <class State>
std::optional<Found> findValue(const State& state, const std::string& name) {
  std::optional<Found> found;
  for (const auto& entry : state.node) {
    const double factor = factorOf(entry.first.Scalar(), name);
    if (factor == 0.0) continue;
    if (found) fail(state.where(entry.first.Mark().line), name + " is given twice", "keep one unit");
    found = Found{entry.second, factor};
  }
  return found;
}

template <class State>
double toNumber(const State& state, const std::string& name, const YAML::Node& value, double factor,
                bool is_product = false) {
  double number = 0.0;
  const std::string where = state.where(value.Mark().line);
  if (!value.IsScalar()) fail(where, name + " is " + kindOf(value), "give one number");
  std::string text = value.Scalar();
  if (text == ".nan" || text == ".NaN" || text == ".NAN") text = "nan";
  if (text.ends_with(".inf") || text.ends_with(".Inf") || text.ends_with(".INF")) text = "inf";
  if (!parseNumber(text, number))
    fail(where, name + " = '" + shortened(value.Scalar()) + "', must be a number", "write it without a unit");
  if (!std::isfinite(number))
    fail(where, name + " = " + value.Scalar() + ", must be finite", "state a number");
  if (!isDecimal(text))
    fail(where, name + " = " + value.Scalar() + ", must be decimal, without leading zeros",
         "to YAML 1.1 it is octal");
  const double size = std::abs(number * factor);
  if (!plausible(is_product ? std::sqrt(size) : size))
    fail(where, name + (is_product ? ", root of " : " = ") + value.Scalar() + ", " + kPlausible,
         "check its unit");
  return number * factor;
}

template <class State>
Estimate toStated(const State& state, const std::string& name, const Found& found) {
  if (!found.value.IsMap()) return {toNumber(state, name, found.value, found.factor), 0.0};
  Estimate stated;
  bool has_mean = false, has_std = false;
  for (const auto& entry : found.value) {
    const std::string key = entry.first.Scalar();
    if (key != "mean" && key != "std")
      fail(state.where(entry.first.Mark().line), name + ": unknown key '" + shortened(key) + "'",
           "write {mean: M, std: S}");
    if (key == "mean" ? has_mean : has_std)
      fail(state.where(entry.first.Mark().line), name + ": " + key + " appears twice", "remove one");
    (key == "mean" ? stated.value : stated.std) =
        toNumber(state, name + "." + key, entry.second, found.factor);
    (key == "mean" ? has_mean : has_std) = true;
  }
  const std::string where = state.where(found.value.Mark().line);
  if (!has_mean || !has_std)
    fail(where, name + " lacks its " + (has_mean ? "std" : "mean"), "write {mean: M, std: S}");
  if (!(stated.std > 0.0))
    fail(where, name + ".std must be > 0",
         "no measurement is exact: give its standard deviation, or the mean alone for the default");
  return stated;
}

}  // namespace

bool YamlFields::has(const std::string& name) const {
  return findValue(*state_, name).has_value();
}

double YamlFields::number(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) refuse("", "lacks " + name, "add it");
  return toNumber(*state_, name, found->value, found->factor);
}

double YamlFields::number(const std::string& name, double fallback) const {
  return has(name) ? number(name) : fallback;
}

Estimate YamlFields::stated(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) refuse("", "lacks " + name, "add it as a number or {mean: M, std: S}");
  return toStated(*state_, name, *found);
}

Estimate YamlFields::stated(const std::string& name, double fallback) const {
  return has(name) ? stated(name) : Estimate{fallback, 0.0};
}

int YamlFields::integer(const std::string& name) const {
  const double value = number(name);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    refuse(name, name + " must be a whole number", "round it");
  return static_cast<int>(value);
}

int YamlFields::integer(const std::string& name, int fallback) const {
  return has(name) ? integer(name) : fallback;
}

bool YamlFields::flag(const std::string& name, bool fallback) const {
  const auto found = findValue(*state_, name);
  if (!found) return fallback;
  bool value = false;
  if (!found->value.IsScalar() || !YAML::convert<bool>::decode(found->value, value))
    refuse(name, name + " is " + kindOf(found->value), "write true or false");
  return value;
}

std::string YamlFields::word(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) refuse("", "lacks " + name, "add it");
  if (!found->value.IsScalar()) refuse(name, name + " is " + kindOf(found->value), "write one word");
  return wordOf(found->value, where(name), name);
}

std::string YamlFields::word(const std::string& name, const std::string& fallback) const {
  return has(name) ? word(name) : fallback;
}

std::vector<double> YamlFields::numbers(const std::string& name, bool are_products) const {
  const auto found = findValue(*state_, name);
  if (!found) return {};
  if (!found->value.IsSequence()) refuse(name, name + " is " + kindOf(found->value), "write a list [a, b]");
  std::vector<double> values;
  for (const auto& item : found->value)
    values.push_back(toNumber(*state_, name, item, found->factor, are_products));
  return values;
}

std::vector<std::string> YamlFields::texts(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) return {};
  if (found->value.IsScalar()) return {wordOf(found->value, where(name), name)};
  const auto asText = [&](const YAML::Node& item) {
    std::string text = item.IsScalar() ? item.Scalar() : "";
    for (std::size_t i = 0; item.IsSequence() && i < item.size(); ++i)
      if (item[i].IsScalar()) text += (i == 0 ? "" : ",") + item[i].Scalar();
    if (text.empty()) fail(state_->where(item.Mark().line), name + " has an item that is not text", "fix it");
    return text;
  };
  if (!found->value.IsSequence()) refuse(name, name + " is " + kindOf(found->value), "write a list [a, b]");
  std::vector<std::string> all;
  for (const auto& item : found->value) all.push_back(asText(item));
  return all;
}

YamlFields YamlFields::fields(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) refuse("", "lacks " + name, "add it");
  return of(found->value, state_->origin, name);
}

std::vector<YamlFields> YamlFields::list(const std::string& name) const {
  const auto found = findValue(*state_, name);
  if (!found) return {};
  if (!found->value.IsSequence())
    refuse(name, name + " is " + kindOf(found->value), "write a list, each item after `- `");
  std::vector<YamlFields> items;
  for (const auto& item : found->value) items.push_back(of(item, state_->origin, "an item of " + name));
  return items;
}

bool YamlFields::isMapping(const std::string& name) const {
  const auto found = findValue(*state_, name);
  return found && found->value.IsMap();
}

std::vector<std::string> YamlFields::names() const {
  std::vector<std::string> names;
  for (const auto& entry : state_->node) names.push_back(entry.first.Scalar());
  return names;
}

namespace {

std::string remedyFor(const std::string& key, const std::vector<std::string>& known) {
  const std::string meant = meantKey(key, known);
  if (!meant.empty()) return "did you mean " + meant + "?";
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  return "remove it; known are " + all;
}

}  // namespace

void YamlFields::only(const std::vector<std::string>& known) const {
  std::set<std::string> stated;
  for (const auto& entry : state_->node) {
    const std::string key = entry.first.Scalar();
    const auto states = [&](const std::string& name) { return factorOf(key, name) != 0.0; };
    if (const auto found = std::find_if(known.begin(), known.end(), states); found != known.end()) {
      if (!stated.insert(*found).second)
        fail(state_->where(entry.first.Mark().line), *found + " is given twice", "keep one unit");
      continue;
    }
    fail(state_->where(entry.first.Mark().line), "unknown key '" + shortened(key) + "'",
         remedyFor(key, known));
  }
}

void YamlFields::refuse(const std::string& name, const std::string& reason, const std::string& remedy) const {
  const std::string owner = name.empty() && !state_->what.empty() ? state_->what + " " : "";
  fail(where(name), owner + reason, remedy);
}

void YamlFields::refuse(const std::exception& range_error) const {
  const std::string text = range_error.what();
  const auto end = text.find(" = "), begin = text.rfind(": ", end);
  const bool named = end != std::string::npos && begin != std::string::npos;
  std::string field = named ? text.substr(begin + 2, end - begin - 2) : "";
  if (const auto dot = field.rfind('.'); dot != std::string::npos) field = field.substr(dot + 1);
  fail(where(field), text, "correct the value");
}

std::string YamlFields::where(const std::string& name) const {
  for (const auto& entry : state_->node)
    if (!name.empty() && factorOf(entry.first.Scalar(), name) != 0.0)
      return state_->where(entry.first.Mark().line);
  return state_->where(state_->node.Mark().line);
}

}  // namespace talus::terramech
