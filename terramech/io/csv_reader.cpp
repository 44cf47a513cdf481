#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <deque>
#include <fstream>
#include <limits>
#include <new>
#include <system_error>
#include <utility>

#include <csv.h>
#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::terramech {

namespace {

/// Returns the length of the UTF-8 character at the start of a text; 0 for a NUL or invalid bytes.
std::size_t letterBytes(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first == 0 ? 0 : 1;
  const std::size_t bytes = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool no_letter = (first == 0xED && byte(1) > 0x9F) || (first == 0xF4 && byte(1) > 0x8F);
  return overlong || no_letter ? 0 : bytes;
}

}  // namespace

bool isText(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = letterBytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

bool parseNumber(std::string_view field, double& value) noexcept {
  if (field.starts_with('+')) field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc{} && end == field.data() + field.size();
}

bool allNumbers(const std::vector<std::string>& fields, std::vector<double>& numbers) {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  bool any = false;
  numbers.clear();
  for (const std::string& field : fields) {
    double value = kMissing;
    if (!field.empty() && !parseNumber(field, value)) return false;
    any |= !field.empty();
    numbers.push_back(std::isfinite(value) ? value : kMissing);
  }
  return any;
}

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

namespace {

constexpr std::size_t kMostColumns = 1000;

// Returns the field separator, from the first line that is neither empty nor a comment: the most frequent of
// comma, semicolon and tab, or else blanks.
char separatorOf(std::string_view text) {
  std::string_view line;
  do {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of("\r\n ")));
    line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(line.size());
  } while (line.starts_with('#'));
  char most = ',';
  for (const char c : {';', '\t'})
    if (std::ranges::count(line, c) > std::ranges::count(line, most)) most = c;
  return line.find(most) == line.npos && line.find(' ') != line.npos ? ' ' : most;
}

}  // namespace

/// State of libcsv, which returns fields and record ends by callbacks; complete records wait in a queue.
struct CsvReader::Parser {
  explicit Parser(const TableFile& table);
  ~Parser() { csv_free(&csv); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  void open();
  void readHeader();
  bool pop(CsvRow& row);
  void feed();
  void endRecord(int terminator);
  std::string faultOf(const CsvRow& row) const;
  [[noreturn]] void refuse(const std::string& reason, const std::string& remedy) const;

  TableFile table;
  std::filesystem::path path;
  std::optional<TableColumns> columns;
  char separator = ',';
  std::ifstream file;
  std::uintmax_t size = 0, read = 0;
  csv_parser csv{};
  std::vector<std::string> header;
  std::deque<CsvRow> ready;
  CsvRow current;
  std::size_t line = 1;       // first line of the current record
  std::size_t swallowed = 0;  // line of a record whose quotes enclose other rows; 0: none
  bool after_return = false;  // the last record ended with CR: a following LF belongs to it
  bool done = false;
};

CsvReader::Parser::Parser(const TableFile& asked) : table(asked), path(asked.path) {
  if (csv_init(&csv, CSV_REPALL_NL) != 0) throw std::bad_alloc();
}

void CsvReader::Parser::open() {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse("is a directory", "name a CSV file");
  checkInput(path.string());
  file.open(path, std::ios::binary);
  if (!file) refuse(std::strerror(errno), "check the path and its permissions");
  size = std::filesystem::file_size(path, error);
  readHeader();
}

void CsvReader::Parser::refuse(const std::string& reason, const std::string& remedy) const {
  throw InputError({.where = path.string(), .reason = reason, .remedy = remedy});
}

void CsvReader::Parser::readHeader() {
  CsvRow row;
  if (!pop(row)) refuse("is empty", "the first row names the columns");
  header = row.fields;
  if (header.size() > kMostColumns)
    refuse("has " + std::to_string(header.size()) + " columns, at most 1000 can be read",
           "keep those that are needed");
  for (const std::string& name : header)
    if (!name.empty() && std::ranges::count(header, name) > 1)
      throw InputError({path.string() + ":" + std::to_string(row.line),
                        "column " + name + " appears twice in the header", "rename one"});
  std::vector<std::string> names = header;
  if (CsvRow below; pop(below) && !takeUnits(names, below.fields, path.string()))
    ready.push_front(std::move(below));
  columns.emplace(std::move(names), table, separator != ',');
}

bool CsvReader::Parser::pop(CsvRow& row) {
  while (ready.empty() && !done) feed();
  if (ready.empty()) return false;
  row = std::move(ready.front());
  ready.pop_front();
  if (!columns) return true;
  if (row.fault.empty()) row.fault = faultOf(row);
  columns->apply(row.fields, row.fault.empty());
  return true;
}

void CsvReader::Parser::feed() {
  std::array<char, 1 << 16> buffer;
  file.read(buffer.data(), buffer.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  if (read == 0 && std::memchr(buffer.data(), 0, count))
    refuse("is not text", "save it as UTF-8 text with commas");
  std::size_t skip = 0;  // skip byte order marks, which would become part of the first column's name
  while (read == 0 && std::string_view(buffer.data() + skip, count - skip).starts_with("\xEF\xBB\xBF"))
    skip += 3;
  if (read == 0) {
    separator = separatorOf(std::string_view(buffer.data() + skip, count - skip));
    csv_set_delim(&csv, static_cast<unsigned char>(separator));
  }
  read += count;
  const auto field = [](void* text, std::size_t length, void* parser) {
    static_cast<Parser*>(parser)->current.fields.emplace_back(static_cast<const char*>(text), length);
  };
  const auto end_of_record = [](int terminator, void* parser) {
    static_cast<Parser*>(parser)->endRecord(terminator);
  };
  if (csv_parse(&csv, buffer.data() + skip, count - skip, field, end_of_record, this) != count - skip)
    refuse(csv_strerror(csv_error(&csv)), "");
  if (swallowed == 0 && file) return;
  done = true;
  constexpr int kFieldBegun = 2;  // state of libcsv inside a field
  const bool open_quote = csv.pstate == kFieldBegun && csv.quoted;
  if (open_quote && swallowed == 0) swallowed = line;
  if (swallowed > 0)
    throw InputError({.where = path.string() + ":" + std::to_string(swallowed),
                      .reason = "a quote of this line holds the rows behind it",
                      .remedy = "close or remove it"});
  csv_fini(&csv, field, end_of_record, this);
}

void CsvReader::Parser::endRecord(int terminator) {
  if (terminator == '\n' && after_return && current.fields.empty()) {
    after_return = false;
    return;
  }
  after_return = terminator == '\r';
  current.line = line;
  const auto holds_rows = [this](const std::string& f) {
    return f.find(separator) != std::string::npos && f.find_first_of("\r\n") != std::string::npos;
  };
  if (swallowed == 0 && std::ranges::any_of(current.fields, holds_rows)) swallowed = line;
  for (const auto& f : current.fields) line += static_cast<std::size_t>(std::count(f.begin(), f.end(), '\n'));
  ++line;
  if (separator == ' ') std::erase(current.fields, "");  // between blanks
  const bool before_header = header.empty() && ready.empty();
  const bool comment = !current.fields.empty() && current.fields.front().starts_with('#') &&
                       (before_header || current.fields.size() == 1 || current.fields.front() == "#");
  if (!current.fields.empty() && !comment) ready.push_back(std::move(current));
  current = {};
}

std::string CsvReader::Parser::faultOf(const CsvRow& row) const {
  if (row.fields == header) return "repeats the header";
  std::size_t fields = row.fields.size();
  while (fields > header.size() && row.fields[fields - 1].empty()) --fields;
  if (fields == header.size()) return "";
  return "has " + std::to_string(row.fields.size()) + " fields, the header " + std::to_string(header.size());
}

CsvReader::CsvReader(const TableFile& table) : parser_(std::make_unique<Parser>(table)) {
  parser_->open();
}

CsvReader::~CsvReader() = default;

const std::vector<std::string>& CsvReader::header() const noexcept {
  return parser_->columns->header();
}

bool CsvReader::next(CsvRow& row) {
  return parser_->pop(row);
}

double CsvReader::fraction() const noexcept {
  return parser_->size ? static_cast<double>(parser_->read) / static_cast<double>(parser_->size) : 1.0;
}

std::string csvField(std::string_view text) {
  const bool outer_blank = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (!outer_blank && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

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
