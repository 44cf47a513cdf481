#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Valid range of a known column.
struct Rule {
  const char* column;
  bool (*holds)(double);
  const char* bound;
};

bool isPlace(double x) {
  return std::abs(x) <= 1e9;
}

constexpr Rule kRules[] = {
    {"load_N", [](double x) { return x > 0.0 && x <= 1e7; }, "> 0 and at most 1e7"},
    {"sinkage_m", [](double x) { return x >= 0.0; }, ">= 0"},
    {"slip", [](double x) { return x >= -1.0 && x <= 1.0; }, "in [-1, 1]"},
    // Limit above a right angle, because of measurement errors: tables of wheels pulled sideways reach 1.577.
    {"slip_angle_rad", [](double x) { return std::abs(x) <= 1.6; }, "in [-1.6, 1.6]"},
    {"slope_rad", [](double x) { return std::abs(x) <= 1.5; }, "in [-1.5, 1.5]"},
    {"pitch_rad", [](double x) { return std::abs(x) <= 1.5; }, "in [-1.5, 1.5]"},
    {"roll_rad", [](double x) { return std::abs(x) <= 1.5; }, "in [-1.5, 1.5]"},
    {"pass_index", [](double x) { return x >= 1.0 && x <= 1e6 && x == std::floor(x); },
     "1, 2, ... up to 1e6"},
    {"x_m", isPlace, "within 1e9 of 0"},
    {"y_m", isPlace, "within 1e9 of 0"},
    {"z_m", isPlace, "within 1e9 of 0"},
    {"wheel_radius_m", [](double x) { return x >= 1e-3 && x <= 10.0; }, "in [0.001, 10]"},
    {"wheel_width_m", [](double x) { return x >= 1e-3 && x <= 10.0; }, "in [0.001, 10]"},
    {"grouser_height_m", [](double x) { return x >= 0.0 && x <= 1.0; }, "in [0, 1]"},
    {"grouser_count", [](double x) { return x >= 0.0 && x <= 1000.0; }, "in [0, 1000]"},
    {"shear_modulus_m", [](double x) { return x >= 1e-9 && x <= 1e3; }, "in [1e-9, 1000]"},
};

// Smaller magnitudes are rounding errors of 0, for example of tan(0), and are replaced by 0; plausible() uses
// the same limit.
constexpr double kDust = 1e-15;

/// One column of the file while it is read.
struct Column {
  std::string name;
  bool known = false;     // numeric; a fault rejects the row
  bool required = false;  // must not be empty
  const Rule* rule = nullptr;
  std::vector<double> numbers;
  std::vector<double> rejected;    // values of rejected rows
  std::vector<std::string> words;  // unknown column, until all values are read
};

Column columnNamed(const std::string& name, const TelemetryOptions& options) {
  Column column;
  column.name = name;
  column.required = std::ranges::count(options.required, name) > 0;
  column.known = column.required || std::ranges::count(knownTelemetryColumns(), name) > 0;
  for (const Rule& rule : kRules)
    if (name == rule.column) column.rule = &rule;
  return column;
}

/// Parses a decimal beyond the range of double as the largest double or as 0, because "1e999" is known to be
/// large.
bool beyondDouble(const std::string& field, double& value) {
  std::istringstream in(field);
  in.imbue(std::locale::classic());
  in >> value;
  return in.fail() ? std::abs(value) == std::numeric_limits<double>::max() : in.peek() == EOF;
}

/// Returns the number in a field of a known column; sets `fault` if the row must be rejected.
double checkedNumber(const Column& column, const std::string& field, std::string& fault) {
  if (field.empty()) {
    if (column.required) fault = column.name + " is empty";
    return kMissing;
  }
  double value = 0.0;
  if (!parseNumber(field, value)) {
    fault = column.name + " = '" + field + "', must be a number";
  } else if (!std::isfinite(value)) {
    fault = column.name + " = " + field + ", must be finite";
  } else {
    if (std::abs(value) < kDust) value = 0.0;
    if (!plausible(value))
      fault = column.name + " = " + field + ", " + kPlausible;
    else if (column.rule && !column.rule->holds(value))
      fault = column.name + " = " + field + ", must be " + column.rule->bound;
  }
  return value;
}

// Odds that a column is in percent or degrees, of whose values some lie beyond the ratios or radians of a rover. In
// its own unit these are faults, whose share has the prior Beta(1, 40); in another unit the share is uniform. The
// prior odds of another unit are 0.01 (ours).
double oddsOfOtherUnit(double beyond, double all) {
  constexpr double kPriorOdds = 0.01, kFaults = 40.0;
  const double within = all - beyond;
  return kPriorOdds / kFaults *
         std::exp(std::lgamma(within + 1.0) - std::lgamma(all + 2.0) - std::lgamma(within + kFaults) +
                  std::lgamma(all + kFaults + 1.0));
}

class Table {
 public:
  Table(const std::vector<std::string>& header, const TelemetryOptions& options)
      : radius_m_(options.wheel_radius_m) {
    for (const auto& name : header) columns_.push_back(columnNamed(name, options));
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (columns_[k].name == "sinkage_m") sinkage_ = k;
      if (columns_[k].name == "wheel_radius_m") radius_ = k;
    }
    values_.resize(columns_.size());
  }

  /// Adds the row, or returns why the row is rejected.
  std::string add(const CsvRow& row) {
    std::string fault = row.fault;
    for (std::size_t k = 0; k < columns_.size() && fault.empty(); ++k)
      if (columns_[k].known) values_[k] = checkedNumber(columns_[k], row.fields[k], fault);
    if (fault.empty()) fault = sinkageFault();
    if (!fault.empty()) {
      for (std::size_t k = 0; k < columns_.size(); ++k)
        if (columns_[k].known) columns_[k].rejected.push_back(asRead(row, k));
      return fault;
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (columns_[k].known)
        columns_[k].numbers.push_back(values_[k]);
      else
        columns_[k].words.push_back(row.fields[k]);
    }
    return "";
  }

  /// Refuses a column that is probably in another unit than its name states, unless `stated` has its unit: percent,
  /// degrees, or times since 1970 in less than seconds.
  void refuseOtherUnits(const std::string& where, const std::vector<MappedColumn>& stated) const {
    constexpr double kMostOdds = 0.25;  // rows of another unit may hide danger
    for (const Column& column : columns_) {
      const auto settles = [&](const MappedColumn& m) { return m.known == column.name && !m.unit.empty(); };
      if (!column.known || std::ranges::any_of(stated, settles)) continue;
      const auto count = [&](double least, double most) {
        const auto lies = [&](double v) { return std::abs(v) > least && std::abs(v) <= most; };
        return std::ranges::count_if(column.rejected, lies) + std::ranges::count_if(column.numbers, lies);
      };
      constexpr double kMost = std::numeric_limits<double>::max();
      const auto all = count(-1.0, kMost);
      const auto refuseIfOdd = [&](double least, double most, const char* as, const char* unit,
                                   const char* own) {
        const auto odd = count(least, most);
        if (oddsOfOtherUnit(static_cast<double>(odd), static_cast<double>(all)) > kMostOdds)
          throw InputError({where + ", column " + column.name,
                            fmt::format("{} of {} values lie beyond {:.3g}, as {} do", odd, all, least, as),
                            fmt::format("pass --column {0}={0}:{1}, or {0}={0}:{2} if it is right as it is",
                                        column.name, unit, own)});
      };
      const std::string& name = column.name;
      if (name == "slip") refuseIfOdd(1.6, 360.0, "percent", "percent", "ratio");
      // Headings may turn on, and a slip angle is near pi in reverse.
      const double turn = name == "heading_rad"      ? 8.0 * std::numbers::pi
                          : name == "slip_angle_rad" ? 3.2
                                                     : 1.6;
      if (name.ends_with("_rad")) refuseIfOdd(turn, 360.0, "degrees", "deg", "rad");
      if (name != "time_s") continue;
      refuseIfOdd(1e11, 1e14, "milliseconds since 1970", "ms", "s");
      refuseIfOdd(1e14, 1e17, "microseconds since 1970", "us", "s");
      refuseIfOdd(1e17, kMost, "nanoseconds since 1970", "ns", "s");
    }
  }

  void moveInto(Telemetry& telemetry) {
    for (Column& column : columns_) {
      if (column.name.empty()) continue;
      if (column.known) telemetry.rejected_numbers.push_back({column.name, std::move(column.rejected)});
      const bool texts = column.name == "run" || column.name == "wheel";
      if (column.known || (!texts && allNumbers(column.words, column.numbers)))
        telemetry.numbers.push_back({column.name, std::move(column.numbers)});
      else
        telemetry.words.push_back({column.name, std::move(column.words)});
    }
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  static double asRead(const CsvRow& row, std::size_t k) {
    double value = kMissing;
    return k < row.fields.size() && (parseNumber(row.fields[k], value) || beyondDouble(row.fields[k], value))
               ? value
               : kMissing;
  }

  std::string sinkageFault() const {
    if (sinkage_ == kNone) return "";
    const double radius = radius_ != kNone && !std::isnan(values_[radius_]) ? values_[radius_] : radius_m_;
    if (radius <= 0.0 || !(values_[sinkage_] >= 2.0 * radius)) return "";
    return "sinkage_m = " + fmt::format("{:g}", values_[sinkage_]) + ", must be < the wheel's diameter, " +
           fmt::format("{:g}", 2.0 * radius);
  }

  std::vector<Column> columns_;
  std::vector<double> values_;
  std::size_t sinkage_ = kNone, radius_ = kNone;
  double radius_m_;
};

/// Detects rows that repeat earlier ones, as in a log that was assembled from overlapping files.
class RepeatedRows {
 public:
  explicit RepeatedRows(const std::vector<std::string>& header) {
    for (std::size_t k = 0; k < header.size(); ++k) {
      if (header[k] == "time_s") time_ = k;
      if (header[k] == "wheel") wheel_ = k;
    }
  }

  bool operator()(const CsvRow& row) {
    const auto field = [&](std::size_t k) { return k < row.fields.size() ? row.fields[k] : std::string(); };
    const std::string time = field(time_);
    if (time.empty()) return false;
    if (moments_ == 0 || time != last_time_) ++moments_;
    last_time_ = time;
    std::string all;
    for (const std::string& text : row.fields) (all += text) += '\0';
    const auto [earlier, fresh] = moment_.try_emplace(std::hash<std::string>()(all), moments_);
    return !fresh && (earlier->second != moments_ || !field(wheel_).empty());
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t time_ = kNone, wheel_ = kNone;
  std::string last_time_;
  std::size_t moments_ = 0;
  std::unordered_map<std::size_t, std::size_t> moment_;  // moment of each row, by the hash of the row
};

void checkColumns(const std::vector<std::string>& header, const std::vector<std::string>& required,
                  const std::string& where) {
  std::string missing;
  for (const auto& name : required)
    if (std::ranges::count(header, name) == 0) missing += (missing.empty() ? "" : ", ") + name;
  if (missing.empty()) return;
  throw InputError(
      {.where = where + ":1",
       .reason = "no column " + missing,
       .remedy = "name it in the header row, with its unit as suffix, or pass --column load_N=NAME"});
}

void checkUsable(const Telemetry& telemetry) {
  if (telemetry.size() > 0) return;
  if (telemetry.rejected.empty())
    throw InputError(
        {.where = telemetry.source, .reason = "no rows after the header", .remedy = "add measurements"});
  const auto& first = telemetry.rejected.front();
  throw InputError({.where = telemetry.source + ":" + std::to_string(first.line),
                    .reason = "no usable row; " + std::to_string(telemetry.rejected.size()) +
                              " refused, this one because " + first.reason,
                    .remedy = "correct the rows"});
}

}  // namespace

Telemetry readTelemetry(const TableFile& file, const TelemetryOptions& options,
                        const ProgressMonitor& watch) {
  CsvReader reader{file};
  Telemetry telemetry;
  telemetry.source = file.path;
  // numbers of eight bytes in vectors that grow by doubling, from fields of some five
  constexpr double kBytesPerByte = 4.0;
  std::error_code unknown;
  if (const std::uintmax_t bytes = std::filesystem::file_size(file.path, unknown); !unknown)
    requireMemory(kBytesPerByte * static_cast<double>(bytes), telemetry.source);
  checkColumnUnits(reader.header(), knownTelemetryColumns(), telemetry.source);
  checkColumns(reader.header(), options.required, telemetry.source);
  Table table{reader.header(), options};
  RepeatedRows repeats(reader.header());
  CsvRow row;
  for (std::size_t count = 0; reader.next(row); ++count) {
    if (options.once && repeats(row))
      ++telemetry.repeated;
    else if (std::string fault = table.add(row); fault.empty())
      telemetry.lines.push_back(row.line);
    else
      telemetry.rejected.push_back({row.line, std::move(fault)});
    if (count % 65536 != 65535) continue;
    if (watch.stopped()) break;
    watch.report(reader.fraction());
  }
  table.refuseOtherUnits(telemetry.source, file.columns);
  table.moveInto(telemetry);
  checkUsable(telemetry);
  return telemetry;
}

}  // namespace talus::terramech
