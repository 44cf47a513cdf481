#include <cmath>
#include <limits>
#include <optional>

#include <costmap/drive_evidence.hpp>

namespace talus::costmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The columns of a telemetry file as readings.
class Rows {
 public:
  Rows(const terramech::Telemetry& telemetry, const TraversabilityMap& map)
      : map_(map),
        x_(telemetry.at("x_m")),
        y_(telemetry.at("y_m")),
        load_(telemetry.at("load_N")),
        slip_(telemetry.at("slip")),
        time_(telemetry.find("time_s")),
        torque_(telemetry.find("torque_Nm")),
        sinkage_(telemetry.find("sinkage_m")),
        slope_(telemetry.find("slope_rad")),
        heading_(telemetry.find("heading_rad")),
        pull_(telemetry.find("drawbar_pull_N")),
        pass_(telemetry.find("pass_index")),
        wheel_(telemetry.findWords("wheel")),
        run_(telemetry.findWords("run")) {}

  WheelReading reading(std::size_t i) const {
    const auto value = [i](const std::vector<double>* column) { return column ? (*column)[i] : kNone; };
    WheelReading r{.time_s = value(time_),
                   .place = {x_[i], y_[i]},
                   .load_N = load_[i],
                   .slip = slip_[i],
                   .torque_Nm = value(torque_),
                   .sinkage_m = value(sinkage_),
                   .gradient = std::tan(value(slope_)),
                   .drawbar_pull_N = value(pull_),
                   .pass = 1};
    if (std::isfinite(value(pass_))) r.pass = static_cast<int>(value(pass_));
    if (std::isnan(r.gradient)) r.gradient = mapGradient(r.place, value(heading_));
    return r;
  }

  // Wheel and run together name a series in time.
  std::string series(std::size_t i) const {
    return (run_ ? (*run_)[i] : std::string()) + '/' + (wheel_ ? (*wheel_)[i] : std::string());
  }

 private:
  double mapGradient(const maps::Point& place, double heading_rad) const {
    const auto cell = map_.grid().cellAt(place);
    if (!cell || std::isnan(heading_rad)) return kNone;
    const CellCode code = map_.code(*cell);
    return code.dzDx() * std::cos(heading_rad) + code.dzDy() * std::sin(heading_rad);
  }

  const TraversabilityMap& map_;
  const std::vector<double>&x_, &y_, &load_, &slip_;
  const std::vector<double>*time_, *torque_, *sinkage_, *slope_, *heading_, *pull_, *pass_;
  const std::vector<std::string>*wheel_, *run_;
};

std::optional<int> classAt(const TraversabilityMap& map, const maps::Point& place) {
  const auto cell = map.grid().cellAt(place);
  if (!cell || map.classIndex(*cell) < 0) return std::nullopt;
  return map.classIndex(*cell);
}

// The first look: is there a bias in torque or sinkage that all ground shares?
bool torqueBiased(const TraversabilityMap& map, const Rows& rows, std::size_t count) {
  SensorWatch watch(map.model());
  const WheelObserver observer(map.model());
  for (std::size_t i = 0; i < count; ++i) {
    const WheelReading reading = rows.reading(i);
    const auto index = classAt(map, reading.place);
    if (!index || watch.refuse(rows.series(i), reading)) continue;
    if (const auto seen = observer.observe(*index, reading)) watch.compare(*seen);
  }
  return watch.biased();
}

std::string refusal(TraversabilityMap& map, const JournalRow& row, bool observed) {
  if (!classAt(map, row.reading.place)) return "outside the map or on ground without a soil";
  if (!observed) return "says nothing: neither slope, nor torque with sinkage, nor drawbar pull";
  return map.learn(row.observation) ? "" : "no ground to learn about there";
}

}  // namespace

DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry,
                     EvidenceJournal* journal) {
  const Rows rows(telemetry, map);
  const bool biased = torqueBiased(map, rows, telemetry.size());
  SensorWatch watch(map.model());
  const WheelObserver observer(map.model());
  DriveReport report;
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    JournalRow row{.source = telemetry.source,
                   .line = static_cast<std::int64_t>(telemetry.lines[i]),
                   .accepted = false,
                   .reason = {},
                   .reading = rows.reading(i),
                   .observation = {}};
    WheelReading believed = row.reading;
    if (biased) believed.torque_Nm = believed.sinkage_m = kNone;
    if (const auto reason = watch.refuse(rows.series(i), row.reading)) row.reason = *reason;
    if (row.reason.empty()) {
      const auto index = classAt(map, believed.place);
      const auto all = index ? observer.observe(*index, row.reading) : std::nullopt;
      const auto seen = index ? observer.observe(*index, believed) : std::nullopt;
      if (all) watch.compare(*all);
      if (seen) row.observation = *seen;
      row.reason = refusal(map, row, seen.has_value());
    }
    row.accepted = row.reason.empty();
    if (journal) journal->append(row);
    ++(row.accepted ? report.used : report.rejected);
  }
  map.publish();
  report.findings = watch.findings();
  return report;
}

DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal) {
  DriveReport report;
  journal.forEach([&](const JournalRow& row) {
    const bool used = row.accepted && map.learn(row.observation);
    ++(used ? report.used : report.rejected);
  });
  map.publish();
  return report;
}

}  // namespace talus::costmap
