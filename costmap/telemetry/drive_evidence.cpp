#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/observation_fault.hpp>
#include <talus/costmap/telemetry/telemetry_processor.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>
#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::costmap {
namespace {

// Calls take(row, result) for every row, moment by moment.
template <typename Take>
void processRows(const TelemetryRows& rows, const TraversabilityMap& map, TelemetryProcessor& processor,
                 const DriveVerdict& verdict, Take&& take) {
  for (std::vector<std::size_t>& of : rows.byMoment()) {
    const Moment moment = momentOf(rows, std::move(of), map.model().rover());
    auto results = processor.process(rows, moment, verdict);
    for (std::size_t w = 0; w < results.size(); ++w) take(moment.rows[w], std::move(results[w]));
  }
}

// Appends the rows of `part` to `all`, column by column. A column of only one of the two is filled with
// missing values.
void append(terramech::Telemetry& all, const terramech::Telemetry& part) {
  const std::size_t before = all.size(), after = before + part.size();
  const auto join = [&](auto& to, const auto& from, const auto& none) {
    for (const auto& column : from) {
      auto known = std::ranges::find(to, column.name, [](const auto& c) { return c.name; });
      if (known == to.end()) {
        to.push_back({column.name, {}});
        known = std::prev(to.end());
      }
      known->values.resize(before, none);
      known->values.insert(known->values.end(), column.values.begin(), column.values.end());
    }
    for (auto& column : to) column.values.resize(after, none);
  };
  join(all.numbers, part.numbers, std::numeric_limits<double>::quiet_NaN());
  join(all.words, part.words, std::string());
  all.source = part.source;
  all.lines.insert(all.lines.end(), part.lines.begin(), part.lines.end());
}

RowWheel wheelOf(const terramech::Rover& rover) {
  return {rover.wheel.radius_m, rover.wheel.width_m, terramech::wheelLoad_N(rover)};
}

// True if a row of the journal refers to a wheel of this rover; false if the row has no wheel size.
bool isOf(const terramech::Rover& rover, const RowWheel& wheel) {
  const RowWheel own = wheelOf(rover);
  const bool known = std::isfinite(wheel.radius_m + wheel.width_m + wheel.weight_N);
  return known && sameOrUnknown(wheel.radius_m, own.radius_m) && sameOrUnknown(wheel.width_m, own.width_m) &&
         sameOrUnknown(wheel.weight_N, own.weight_N);
}

std::string unobservedFinding(std::size_t places) {
  return std::to_string(places) +
         " places refused: wheels indicate danger where the map has no terrain class";
}

std::string lackingFinding(std::size_t drives) {
  return "the journal lacks " + std::to_string(drives) + (drives == 1 ? " drive" : " drives") +
         " that the map contains, and cannot rebuild this map";
}

void reportDrive(const DriveEstimate& drive, const TraversabilityMap& map, DriveReport& report) {
  report.slip_offset = drive.offset;
  report.slip_scale = drive.sensor.scale;
  for (std::size_t c = 0; c < drive.classes.size(); ++c) {
    const DriveEstimate::OfClass& one = drive.classes[c];
    if (!std::isfinite(one.shared_std)) continue;
    const auto index = static_cast<int>(c);
    const double of_class = map.model().prior(index).pull.value;
    report.learned.push_back({map.model().parts().classes[c].number,
                              {of_class + one.departure.value, one.departure.std},
                              {of_class + one.if_sound.value, one.if_sound.std},
                              map.evidence().classBelief(index).pull.value});
  }
}

// Latest time of a drive [s]; infinite without times.
double lastTime_s(const terramech::Telemetry& telemetry) {
  const std::vector<double>* times = telemetry.find("time_s");
  double last = times ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; times && i < times->size(); ++i) last = std::fmax(last, (*times)[i]);
  return last;
}

std::string othersFinding(std::size_t rows) {
  return std::to_string(rows) +
         " rows: of another wheel or load than the map's rover has; they count as unverified";
}

}  // namespace

struct DriveIntake::State {
  TraversabilityMap& map;
  EvidenceJournal* journal;
  IntakeOptions options;
  std::unique_ptr<TelemetryProcessor> processor;
  DriveReport report{};
  DriveId sum{};                       // identifier of all parts so far
  std::string id{};                    // text of `sum`
  std::optional<std::uint16_t> tag{};  // drive number, from the first part with a row
  std::string sensors{};               // what the sensors were found to be, at the last row with an estimate
  std::vector<JournalRow> rows{};      // rows of the present part
  // Data of all parts, kept only for settle(): measurements, readings counted in the map, places with a
  // bound, and rejected rows that indicate danger.
  using Place = std::tuple<double, double, double>;
  terramech::Telemetry all{};
  std::vector<SavedBlock> counted{};
  std::set<Place> bounded{};
  std::vector<JournalRow> of_rejected{};

  static Place placeOf(const WheelObservation& observation);
  void keep(const WheelObservation& observation);
  void settle();
  using Take = std::function<bool(const WheelObservation&)>;
  void learn(const terramech::Telemetry& telemetry, const TelemetryRows& readings, std::size_t i,
             TelemetryProcessor::Result&& result, const Take& take);
  void put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict,
           const DriveBeginning& known = {});
  void boundRejected(const terramech::Telemetry& telemetry, std::size_t from);
};

DriveIntake::State::Place DriveIntake::State::placeOf(const WheelObservation& observation) {
  return {observation.time_s, observation.place.x_m, observation.place.y_m};
}

void DriveIntake::State::keep(const WheelObservation& observation) {
  WheelObservation estimate = observation;  // bounds remain as first added
  estimate.here = {};
  if (auto heard = map.evidence().readingsOf(estimate)) counted.push_back(std::move(*heard));
  if (observation.here.any()) bounded.insert(placeOf(observation));
}

void DriveIntake::State::learn(const terramech::Telemetry& telemetry, const TelemetryRows& readings,
                               std::size_t i, TelemetryProcessor::Result&& result, const Take& take) {
  const std::string wrong = result.observation ? fault(*result.observation) : "";
  if (!wrong.empty()) {
    result.reason = wrong;
    result.observation = boundAlone(*result.observation);
  }
  if (result.observation) result.observation->drive = tag.value_or(0);
  bool accepted = result.observation.has_value() && fault(*result.observation).empty();
  if (accepted && !take(*result.observation)) {
    accepted = false;
    if (result.reason.empty()) result.reason = "no ground to learn about there";
  }
  if (accepted && options.settles) keep(*result.observation);
  JournalRow row{.source = telemetry.source,
                 .line = static_cast<std::int64_t>(telemetry.lines[i]),
                 .accepted = accepted,
                 .reason = result.reason,
                 .reading = readings.reading(i),
                 .observation = result.observation.value_or(WheelObservation{}),
                 .wheel = wheelOf(map.model().rover())};
  row.observation.drive = tag.value_or(0);
  if (accepted && std::isfinite(row.observation.pull.value)) row.reason = sensors = processor->sensors();
  ++(accepted ? report.used : report.rejected);
  if (accepted && row.observation.trust != Trust::Unverified) ++report.raising;
  if (!accepted && report.first_reason.empty()) report.first_reason = row.reason;
  if (journal) rows.push_back(std::move(row));
}

// Adds the rows of a part. Rows that the map contains already are used for the sensor checks only.
void DriveIntake::State::put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict,
                             const DriveBeginning& known) {
  const TelemetryRows readings(telemetry, map, options.pose_std_m);
  const std::size_t refused = map.surface().refused().size();
  const std::string before = id;
  if (!tag && telemetry.size() + telemetry.rejected.size() > 0) tag = driveTag(telemetry);
  sum.add(telemetry);
  id = sum.text();
  rows.clear();
  processRows(readings, map, *processor, verdict, [&](std::size_t i, TelemetryProcessor::Result&& result) {
    if (i < known.rows) return;
    learn(telemetry, readings, i, std::move(result),
          [&](const WheelObservation& observation) { return map.learn(observation); });
  });
  report.repeated = known.rows;
  if (options.settles) append(all, telemetry);
  const std::size_t read = rows.size();
  boundRejected(telemetry, known.rejected);
  if (options.settles)
    of_rejected.insert(of_rejected.end(), rows.begin() + static_cast<std::ptrdiff_t>(read), rows.end());
  report.unobserved += map.surface().refused().size() - refused;
  if (journal) journal->append(id, rows, before);
  map.noteDrive(id, {tag.value_or(0), sensors}, before);
}

// Replaces the estimates of all rows; bounds of places remain as first added.
void DriveIntake::State::settle() {
  if (!options.settles)
    throw std::logic_error("DriveIntake: IntakeOptions::settles = false, must be true to settle");
  if (all.size() == 0) return;
  const TelemetryRows readings(all, map, options.pose_std_m);
  TelemetryProcessor first_pass(map);
  processRows(readings, map, first_pass, {}, [](std::size_t, TelemetryProcessor::Result&&) {});
  for (const SavedBlock& block : std::exchange(counted, {})) map.forget(block);
  const auto takeAgain = [&](const WheelObservation& observation) {
    WheelObservation estimate = observation;
    estimate.here = {};
    return map.learn(estimate) || bounded.contains(placeOf(observation));
  };
  processor = std::make_unique<TelemetryProcessor>(map);
  report.used = report.raising = report.rejected = 0;
  report.first_reason.clear();
  rows.clear();
  processRows(readings, map, *processor, first_pass.verdict(),
              [&](std::size_t i, TelemetryProcessor::Result&& result) {
                learn(all, readings, i, std::move(result), takeAgain);
              });
  rows.insert(rows.end(), of_rejected.begin(), of_rejected.end());
  if (journal) journal->replace(id, rows);
  map.noteDrive(id, {tag.value_or(0), sensors});
}

// Adds the bounds from rows that the file's reader rejected.
void DriveIntake::State::boundRejected(const terramech::Telemetry& telemetry, std::size_t from) {
  terramech::Telemetry left{.source = telemetry.source, .numbers = telemetry.rejected_numbers};
  if (telemetry.rejected.empty() || !left.find("x_m") || !left.find("y_m") || !left.find("load_N") ||
      !left.find("slip"))
    return;
  const TelemetryRows readings(left, map, options.pose_std_m);
  for (std::size_t i = from; i < readings.size(); ++i) {
    auto heard = processor->rejected(readings, i);
    if (heard) heard->drive = tag.value_or(0);
    if (!heard || !map.learn(*heard)) continue;
    ++report.bounding;
    rows.push_back({.source = telemetry.source,
                    .line = static_cast<std::int64_t>(telemetry.rejected[i].line),
                    .accepted = true,
                    .reason = telemetry.rejected[i].reason,
                    .reading = readings.reading(i),
                    .observation = *heard,
                    .wheel = wheelOf(map.model().rover())});
  }
}

DriveIntake::DriveIntake(TraversabilityMap& map, EvidenceJournal* journal, const IntakeOptions& options)
    : state_(
          std::make_unique<State>(State{map, journal, options, std::make_unique<TelemetryProcessor>(map)})) {}

DriveIntake::~DriveIntake() = default;

void DriveIntake::add(const terramech::Telemetry& telemetry) {
  state_->put(telemetry, {.follows = true});
}

void DriveIntake::settle() {
  state_->settle();
}

void DriveIntake::move(maps::Cell tiles) {
  TraversabilityMap& map = state_->map;
  const MapShift shift(map.grid(), tiles, map.evidence().blockCells());
  map = map.moved(tiles);
  const BlockGrid& blocks = map.evidence().store().blocks;
  for (SavedBlock& saved : state_->counted) saved = shift.block(std::move(saved));
  std::erase_if(state_->counted, [&](const SavedBlock& saved) {
    const auto [column, row] = std::pair{saved.block.column, saved.block.row};
    return column < 0 || row < 0 || column >= blocks.columns() || row >= blocks.rows();
  });
}

DriveReport DriveIntake::report() const {
  DriveReport report = state_->report;
  report.findings = state_->processor->findings();
  if (const std::size_t rows = state_->processor->transferred(); rows > 0)
    report.findings.push_back(std::to_string(rows) +
                              " rows: load_N is an equal share of the weight on a slope; the load transfer "
                              "was computed from the wheel positions");
  report.others = state_->processor->others();
  if (report.others > 0) report.findings.push_back(othersFinding(report.others));
  if (report.bounding > 0)
    report.findings.push_back(std::to_string(report.bounding) +
                              " rejected rows: they indicate danger, which counts where they were read");
  if (report.unobserved > 0) report.findings.push_back(unobservedFinding(report.unobserved));
  return report;
}

DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry, EvidenceJournal* journal,
                     const IntakeOptions& options) {
  const DriveBeginning known = knownBeginning(telemetry, map.drives());
  const bool whole = known.rows == telemetry.size() && known.rejected == telemetry.rejected.size();
  if (whole) {
    DriveReport report;
    report.repeated = telemetry.size();
    return report;
  }
  // The first pass determines the common bias of torque and sinkage, and verifies the sensors.
  TelemetryProcessor first_pass(map);
  processRows(TelemetryRows(telemetry, map, options.pose_std_m), map, first_pass, {},
              [](std::size_t, TelemetryProcessor::Result&&) {});
  DriveIntake intake(map, journal, options);
  const DriveVerdict verdict = first_pass.verdict();
  const double newest_s = map.evidence().newest_s();
  intake.state_->put(telemetry, verdict, known);
  map.publishAll();
  DriveReport report = intake.report();
  if (const double days = (newest_s - lastTime_s(telemetry)) / 86400.0; days > 1.0)
    report.findings.push_back(
        "time_s ends " + std::to_string(std::lround(days)) +
        " days before the newest drive of the map: it counts as older; check the clocks");
  if (verdict.drive && report.raising > 0) reportDrive(*verdict.drive, map, report);
  return report;
}

DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal,
                   const std::set<std::string>& without) {
  DriveReport report;
  const std::size_t refused = map.surface().refused().size();
  std::size_t lacking = map.drives().size();
  for (const std::string& drive : journal.drives()) {
    if (without.contains(drive)) continue;
    if (map.drives().contains(drive)) {
      journal.check(drive);
      --lacking;
      continue;
    }
    TraversabilityMap::Drive note;
    for (JournalRow& row : journal.rows(drive)) {
      note.number = row.observation.drive;
      if (row.accepted && std::isfinite(row.observation.pull.value)) note.sensors = row.reason;
      if (!isOf(map.model().rover(), row.wheel)) {
        row.observation.trust = Trust::Unverified;
        ++report.others;
      }
      const bool used = row.accepted && map.learn(row.observation);
      ++(used ? report.used : report.rejected);
      if (used && row.observation.trust != Trust::Unverified) ++report.raising;
    }
    map.noteDrive(drive, note);
  }
  report.unobserved = map.surface().refused().size() - refused;
  if (lacking > 0) report.findings.push_back(lackingFinding(lacking));
  if (report.unobserved > 0) report.findings.push_back(unobservedFinding(report.unobserved));
  if (report.others > 0) report.findings.push_back(othersFinding(report.others));
  map.publishAll();
  return report;
}

}  // namespace talus::costmap
