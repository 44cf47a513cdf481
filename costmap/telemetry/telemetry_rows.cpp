#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>
#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::costmap {

namespace {

std::string hexadecimal(const Checksum& sum) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016" PRIx64, sum.value());
  return digits.data();
}

// Calls take(row) for each row and take_rejected(row) for each rejected row, in the order of the file: the
// identifier of a drive does not depend on its division into parts.
template <typename Take, typename TakeRejected>
void eachRow(const terramech::Telemetry& telemetry, Take&& take, TakeRejected&& take_rejected) {
  std::size_t rejected = 0;
  const auto addRejected = [&](std::size_t before_line) {
    for (; rejected < telemetry.rejected.size() && telemetry.rejected[rejected].line < before_line;
         ++rejected)
      take_rejected(rejected);
  };
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    addRejected(telemetry.lines[i]);
    take(i);
  }
  addRejected(std::numeric_limits<std::size_t>::max());
}

using Column = const std::vector<double>*;

std::vector<Column> usedOf(const std::vector<terramech::Telemetry::Numbers>& columns) {
  std::vector<Column> used;
  for (const std::string_view name : usedNumberColumns()) {
    used.push_back(nullptr);
    for (const auto& column : columns)
      if (column.name == name) used.back() = &column.values;
  }
  return used;
}

// Adds the values of a row. A missing column counts as a column of NaN.
void addNumbers(Checksum& sum, const std::vector<Column>& columns, std::size_t row) {
  for (const Column column : columns) {
    double value = column ? (*column)[row] : std::numeric_limits<double>::quiet_NaN();
    if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
    sum.add(&value, sizeof value);
  }
}

void addWord(Checksum& sum, const std::string& word) {
  sum.add(word.c_str(), word.size() + 1);
}

// Calls added(rejected) after each row.
template <typename Added>
void addRows(Checksum& sum, const terramech::Telemetry& telemetry, Added&& added) {
  const std::vector<Column> numbers = usedOf(telemetry.numbers),
                            left_out = usedOf(telemetry.rejected_numbers);
  std::vector<const std::vector<std::string>*> words;
  for (const std::string_view name : usedWordColumns()) words.push_back(telemetry.findWords(name));
  eachRow(
      telemetry,
      [&](std::size_t i) {
        addNumbers(sum, numbers, i);
        for (const auto* column : words) addWord(sum, column ? (*column)[i] : std::string());
        added(false);
      },
      [&](std::size_t i) {
        // A row without any number, such as a footer or a repeated header, does not change the identifier.
        const auto holds = [i](Column column) { return column && !std::isnan((*column)[i]); };
        if (std::ranges::any_of(left_out, holds)) addNumbers(sum, left_out, i);
        added(true);
      });
}

}  // namespace

void DriveId::add(const terramech::Telemetry& telemetry) {
  addRows(sum_, telemetry, [](bool) {});
}

std::string DriveId::text() const {
  return hexadecimal(sum_);
}

std::uint16_t driveTag(const terramech::Telemetry& telemetry) {
  std::optional<std::uint16_t> tag;
  Checksum sum;
  addRows(sum, telemetry, [&](bool) {
    if (!tag) tag = static_cast<std::uint16_t>(sum.value());
  });
  return tag.value_or(0);
}

DriveBeginning knownBeginning(const terramech::Telemetry& telemetry,
                              const std::map<std::string, TraversabilityMap::Drive>& drives) {
  DriveBeginning here, known;
  Checksum sum;
  if (drives.empty()) return known;
  addRows(sum, telemetry, [&](bool rejected) {
    ++(rejected ? here.rejected : here.rows);
    if (drives.contains(hexadecimal(sum))) known = here;
  });
  return known;
}

namespace {

constexpr double kSameLoad = 0.01;       // relative difference below which loads are equal
constexpr double kSameWheel = 0.01;      // relative difference below which wheel sizes are equal
constexpr double kSameWeight = 0.25;     // relative difference of total loads below which a row has the
                                         // rover's load; a slope of 25 degrees reduces the load by a tenth
constexpr double kLevelGradient = 0.03;  // gradient below which load transfer is neglected
constexpr double kQuarterTurn = 1.5707963267948966;
constexpr double kTurning_mps = 0.005;  // least rim speed of a turning wheel
constexpr double kVertical_rad = 1.57;
constexpr double kWorstPose_m = 1000.0;  // greatest accepted position uncertainty

double slipOf(double speed_mps, double rim_speed_mps) noexcept {
  return std::abs(rim_speed_mps) > kTurning_mps ? 1.0 - speed_mps / rim_speed_mps
                                                : std::numeric_limits<double>::quiet_NaN();
}

constexpr std::array<std::string_view, 22> kNumbers{
    "drawbar_pull_N", "heading_rad",   "load_N",   "odometry_x_m", "odometry_y_m",   "pass_index",
    "pose_std_m",     "rim_speed_mps", "roll_rad", "sinkage_m",    "slip",           "slip_angle_rad",
    "slope_rad",      "speed_mps",     "time_s",   "torque_Nm",    "wheel_radius_m", "wheel_rate_rad_s",
    "wheel_width_m",  "x_m",           "y_m",      "z_m"};
constexpr std::array<std::string_view, 2> kWords{"run", "wheel"};

}  // namespace

std::span<const std::string_view> usedNumberColumns() noexcept {
  return kNumbers;
}

std::span<const std::string_view> usedWordColumns() noexcept {
  return kWords;
}

TelemetryRows::TelemetryRows(const terramech::Telemetry& telemetry, const TraversabilityMap& map,
                             double pose_std_m)
    : map_(map),
      pose_std_m_(pose_std_m),
      x_(telemetry.at("x_m")),
      y_(telemetry.at("y_m")),
      load_(telemetry.at("load_N")),
      slip_(telemetry.at("slip")),
      time_(telemetry.find("time_s")),
      torque_(telemetry.find("torque_Nm")),
      sinkage_(telemetry.find("sinkage_m")),
      z_(telemetry.find("z_m")),
      slope_(telemetry.find("slope_rad")),
      heading_(telemetry.find("heading_rad")),
      pull_(telemetry.find("drawbar_pull_N")),
      pass_(telemetry.find("pass_index")),
      pose_(telemetry.find("pose_std_m")),
      speed_(telemetry.find("speed_mps")),
      rim_speed_(telemetry.find("rim_speed_mps")),
      roll_(telemetry.find("roll_rad")),
      slip_angle_(telemetry.find("slip_angle_rad")),
      radius_(telemetry.find("wheel_radius_m")),
      width_(telemetry.find("wheel_width_m")),
      rate_(telemetry.find("wheel_rate_rad_s")),
      wheel_(telemetry.findWords("wheel")),
      run_(telemetry.findWords("run")),
      order_(byTime()) {
  measureSecond(telemetry);
}

std::vector<std::size_t> TelemetryRows::byTime() const {
  std::vector<std::tuple<std::string, double, std::string, std::size_t>> rows;
  for (std::size_t i = 0; i < size(); ++i) {
    const bool timed = std::isfinite(value(time_, i));
    rows.emplace_back(time_ ? run(i) : "", timed ? value(time_, i) : kInfinity, timed ? wheel(i) : "", i);
  }
  std::ranges::sort(rows);
  std::vector<std::size_t> order;
  for (const auto& row : rows) order.push_back(std::get<3>(row));
  return order;
}

double TelemetryRows::rimSpeed(std::size_t i) const {
  if (std::isfinite(value(rim_speed_, i))) return value(rim_speed_, i);
  const double radius_m = value(radius_, i);
  return value(rate_, i) * (std::isfinite(radius_m) ? radius_m : map_.model().rover().wheel.radius_m);
}

void TelemetryRows::measureSecond(const terramech::Telemetry& telemetry) {
  constexpr double kCopied = 0.01;  // root mean square difference of slips below which one is computed from
                                    // the other (ours)
  if (!rim_speed_ && !rate_) return;
  const auto *x = telemetry.find("odometry_x_m"), *y = telemetry.find("odometry_y_m");
  if (!x || !y) x = &x_, y = &y_;
  const auto way_m = [&](std::size_t a, std::size_t b) {
    return std::hypot((*x)[b] - (*x)[a], (*y)[b] - (*y)[a]);
  };
  double copied = 0.0, rows = 0.0, jitter_m2 = 0.0, bends = 0.0;
  const auto compare = [&](std::size_t i, double slip) {
    if (!std::isfinite(slip - slip_[i])) return;
    copied += (slip - slip_[i]) * (slip - slip_[i]);
    rows += 1.0;
  };
  second_.assign(size(), std::numeric_limits<double>::quiet_NaN());
  std::map<std::string, std::vector<std::size_t>> of_series;
  for (const std::size_t i : order_) {
    if (speed_) {
      compare(i, second_[i] = slipOf(value(speed_, i), rimSpeed(i)));
      continue;
    }
    std::vector<std::size_t>& before = of_series[series(i)];
    before.push_back(i);
    const std::size_t n = before.size();
    if (n < 3 || !(value(time_, i) > value(time_, before[n - 2]))) continue;
    const std::size_t last = before[n - 2];
    compare(i, slipOf(way_m(last, i) / (value(time_, i) - value(time_, last)), rimSpeed(i)));
    const double bend_x = (*x)[i] - 2.0 * (*x)[last] + (*x)[before[n - 3]],
                 bend_y = (*y)[i] - 2.0 * (*y)[last] + (*y)[before[n - 3]];
    jitter_m2 += (bend_x * bend_x + bend_y * bend_y) / 12.0;
    bends += 1.0;
    double rim_m = 0.0;
    for (std::size_t k = n - 1; k-- > 0;) {
      const double passed_s = value(time_, before[k + 1]) - value(time_, before[k]);
      if (!(passed_s > 0.0)) break;
      rim_m += rimSpeed(before[k + 1]) * passed_s;
      if (way_m(before[k], i) < kSecondWay_m && k > 0) continue;
      second_[i] = std::abs(rim_m) > 0.5 * kSecondWay_m ? 1.0 - way_m(before[k], i) / rim_m : second_[i];
      break;
    }
  }
  second_std_ = bends > 0.0 ? std::sqrt(2.0 * jitter_m2 / bends) / kSecondWay_m : 0.0;
  copied_ = copied < kCopied * kCopied * rows;
  if (copied_) second_.clear();
}

const char* TelemetryRows::settles() const noexcept {
  return copied_           ? "; a second slip settles it: that by rim_speed_mps is computed from slip"
         : second_.empty() ? "; a second slip settles it: give rim_speed_mps and speed_mps"
                           : "; a second slip settles it: that by rim_speed_mps is false or too uncertain";
}

double TelemetryRows::value(const std::vector<double>* column, std::size_t i) {
  return column ? (*column)[i] : std::numeric_limits<double>::quiet_NaN();
}

TelemetryReading TelemetryRows::reading(std::size_t i) const {
  const auto finite = [](double x) {
    return std::isfinite(x) ? x : std::numeric_limits<double>::quiet_NaN();
  };
  TelemetryReading r{.time_s = finite(value(time_, i)),
                     .place = {x_[i], y_[i]},
                     .z_m = finite(value(z_, i)),
                     .load_N = load_[i],
                     .slip = slip_[i],
                     .torque_Nm = value(torque_, i),
                     .sinkage_m = value(sinkage_, i),
                     .gradient = measuredGradient(i),
                     .across = std::tan(finite(value(roll_, i))),
                     .slip_angle_rad = finite(value(slip_angle_, i)),
                     .drawbar_pull_N = value(pull_, i),
                     .pose_std_m = std::isfinite(value(pose_, i))
                                       ? std::clamp(value(pose_, i), 0.0, kWorstPose_m)
                                       : pose_std_m_,
                     .pass = 1,
                     .speed_slip = slipOf(value(speed_, i), value(rim_speed_, i))};
  if (std::isfinite(value(pass_, i))) r.pass = static_cast<int>(value(pass_, i));
  if (std::isnan(r.gradient)) r.gradient = mapGradient(r, heading(i));
  if (std::isnan(r.across)) r.across = mapGradient(r, heading(i) + kQuarterTurn);
  return r;
}

bool TelemetryRows::ofRover(std::size_t i) const {
  const terramech::Wheel& wheel = map_.model().rover().wheel;
  return sameOrUnknown(value(radius_, i), wheel.radius_m) && sameOrUnknown(value(width_, i), wheel.width_m);
}

double TelemetryRows::measuredGradient(std::size_t i) const {
  return std::tan(value(slope_, i));
}

// Gradient of the surface.
double TelemetryRows::mapGradient(const TelemetryReading& r, double direction_rad) const {
  const auto cell = map_.grid().cellAt(r.place);
  if (!cell || std::isnan(direction_rad)) return std::numeric_limits<double>::quiet_NaN();
  const CellCode code = map_.published()->at(*cell);
  return code.dzDx() * std::cos(direction_rad) + code.dzDy() * std::sin(direction_rad);
}

double TelemetryRows::leastGradient(std::size_t i) const {
  const TelemetryReading r = reading(i);
  const double known = std::fmin(measuredSlope(i), mapGradient(r, heading(i)));
  return std::isfinite(known) ? known : steepestDescent(i);
}

double TelemetryRows::steepestDescent(std::size_t i) const {
  const TelemetryReading r = reading(i);
  const double measured = measuredSlope(i);
  const auto cell = map_.grid().cellAt(r.place);
  if (!cell) return std::fmin(measured, 0.0);
  const CellCode code = map_.published()->at(*cell);
  return std::fmin(measured, -std::hypot(code.dzDx(), code.dzDy()));
}

// Measured gradient; NaN if missing or beyond vertical, where the tangent is meaningless.
double TelemetryRows::measuredSlope(std::size_t i) const {
  const double slope_rad = value(slope_, i);
  return std::abs(slope_rad) < kVertical_rad ? std::tan(slope_rad) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::vector<std::size_t>> TelemetryRows::byMoment() const {
  std::vector<std::vector<std::size_t>> moments;
  std::map<std::string, std::size_t>
      read;  // rows of each wheel at one time; the second begins another moment
  std::size_t first = 0, before = 0;
  const terramech::Rover& rover = map_.model().rover();
  const double size_m = std::hypot(rover.wheelbase_m, rover.track_m) + rover.wheel.width_m;
  for (const std::size_t i : order_) {
    const double time_s = value(time_, i), time_before_s = value(time_, before);
    const bool untimed = std::isnan(time_s) && std::isnan(time_before_s),
               beside =
                   !read.contains(wheel(i)) && std::hypot(x_[i] - x_[before], y_[i] - y_[before]) <= size_m;
    if (!wheel_ || run(i) != run(before) || !(untimed ? beside : time_s == time_before_s)) {
      read.clear();
      first = moments.size();
    }
    const std::size_t at = first + read[wheel(i)]++;
    if (at == moments.size()) moments.emplace_back();
    moments[at].push_back(before = i);
  }
  return moments;
}

bool sameOrUnknown(double value, double of_rover) noexcept {
  return !(std::abs(value - of_rover) > kSameWheel * of_rover);
}

bool carriesRover(const std::vector<TelemetryReading>& readings, const terramech::Rover& rover) noexcept {
  double sum_N = 0.0;
  for (const TelemetryReading& r : readings) sum_N += r.load_N;
  const double even_N = terramech::wheelLoad_N(rover) * static_cast<double>(readings.size());
  return std::abs(sum_N - even_N) <= kSameWeight * even_N;
}

Moment momentOf(const TelemetryRows& rows, std::vector<std::size_t> of, const terramech::Rover& rover) {
  Moment moment{.rows = std::move(of), .readings = {}};
  maps::Point middle{0.0, 0.0};
  const auto count = static_cast<double>(moment.rows.size());
  bool same = true;
  for (const std::size_t i : moment.rows) {
    const TelemetryReading& r = moment.readings.emplace_back(rows.reading(i));
    middle.x_m += r.place.x_m / count;
    middle.y_m += r.place.y_m / count;
    const double even_N = terramech::wheelLoad_N(rover);
    same =
        same && std::abs(r.load_N - even_N) < kSameLoad * even_N && r.gradient == moment.readings[0].gradient;
  }
  const double gradient = moment.readings[0].gradient, heading = rows.heading(moment.rows.front());
  const bool whole = moment.readings.size() == static_cast<std::size_t>(rover.wheel_count);
  if (!same || !whole || !(std::abs(gradient) > kLevelGradient) || std::isnan(heading)) return moment;
  std::vector<double> along_m;
  for (const TelemetryReading& r : moment.readings)
    along_m.push_back((r.place.x_m - middle.x_m) * std::cos(heading) +
                      (r.place.y_m - middle.y_m) * std::sin(heading));
  const std::vector<double> loads_N = terramech::wheelLoads_N(rover, gradient, along_m);
  for (std::size_t w = 0; w < loads_N.size(); ++w) moment.readings[w].load_N = loads_N[w];
  moment.transferred = true;
  return moment;
}

}  // namespace talus::costmap
