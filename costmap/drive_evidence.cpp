#include <array>
#include <cinttypes>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <talus/costmap/checksum.hpp>
#include <talus/costmap/drive_evidence.hpp>
#include <talus/costmap/telemetry_processor.hpp>

namespace talus::costmap {
namespace {

// Calls take(row, result) for every row in order.
template <typename Take>
void processRows(const TelemetryRows& rows, const TraversabilityMap& map, TelemetryProcessor& processor,
                 const DriveVerdict& verdict, Take&& take) {
  for (std::size_t first = 0; first < rows.size();) {
    const Moment moment = momentAt(rows, first, map.model().rover());
    for (auto& result : processor.process(rows, moment, verdict)) take(first++, std::move(result));
  }
}

// Row by row, so that a drive has one id however it is divided.
void add(const terramech::Telemetry& telemetry, Checksum& sum) {
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    for (const auto& column : telemetry.numbers) sum.add(&column.values[i], sizeof(double));
    for (const auto& column : telemetry.words)
      sum.add(column.values[i].c_str(), column.values[i].size() + 1);
  }
}

std::string hexadecimal(const Checksum& sum) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016" PRIx64, sum.value());
  return digits.data();
}

}  // namespace

std::string driveId(const terramech::Telemetry& telemetry) {
  Checksum sum;
  add(telemetry, sum);
  return hexadecimal(sum);
}

struct DriveIntake::State {
  TraversabilityMap& map;
  EvidenceJournal* journal;
  IntakeOptions options;
  TelemetryProcessor processor;
  DriveReport report{};
  Checksum sum{};                   // of the parts so far
  std::string id{};                 // by that
  std::vector<JournalRow> rows{};   // of a part

  void learn(const terramech::Telemetry& telemetry, const TelemetryRows& readings, std::size_t i,
             TelemetryProcessor::Result&& result);
  void put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict);
};

void DriveIntake::State::learn(const terramech::Telemetry& telemetry, const TelemetryRows& readings,
                               std::size_t i, TelemetryProcessor::Result&& result) {
  if (result.observation) result.reason = fault(*result.observation);
  bool accepted = result.observation.has_value() && result.reason.empty();
  if (accepted && !map.learn(*result.observation)) {
    accepted = false;
    result.reason = "no ground to learn about there";
  }
  JournalRow row{.source = telemetry.source,
                       .line = static_cast<std::int64_t>(telemetry.lines[i]),
                       .accepted = accepted,
                       .reason = result.reason,
                       .reading = readings.reading(i),
                       .observation = result.observation.value_or(WheelObservation{})};
  ++(accepted ? report.used : report.rejected);
  if (accepted && row.observation.pull_may_raise) ++report.raising;
  if (!accepted && report.first_reason.empty()) report.first_reason = row.reason;
  if (journal) rows.push_back(std::move(row));
}

void DriveIntake::State::put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict) {
  const TelemetryRows readings(telemetry, map, options.pose_std_m);
  const std::string before = id;
  costmap::add(telemetry, sum);
  id = hexadecimal(sum);
  rows.clear();
  processRows(readings, map, processor, verdict, [&](std::size_t i, TelemetryProcessor::Result&& result) {
    learn(telemetry, readings, i, std::move(result));
  });
  if (journal) journal->append(id, rows, before);
  map.noteDrive(id, before);
}

DriveIntake::DriveIntake(TraversabilityMap& map, EvidenceJournal* journal, const IntakeOptions& options)
    : state_(std::make_unique<State>(State{map, journal, options, TelemetryProcessor(map)})) {}

DriveIntake::~DriveIntake() = default;

void DriveIntake::add(const terramech::Telemetry& telemetry) {
  state_->put(telemetry, state_->processor.verdict());
}

DriveReport DriveIntake::report() const {
  DriveReport report = state_->report;
  report.findings = state_->processor.watch().findings();
  if (const std::size_t rows = state_->processor.transferred(); rows > 0)
    report.findings.push_back(std::to_string(rows) +
                              " rows: load_N is an equal share of the weight on a slope; the load transfer "
                              "was computed from the wheel positions");
  return report;
}

DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry, EvidenceJournal* journal,
                     const IntakeOptions& options) {
  if (map.drives().contains(driveId(telemetry))) {
    DriveReport report;
    report.repeated = telemetry.size();
    return report;
  }
  // The first pass: do torque and sinkage have a bias that all ground shares, and which sensors prove sound?
  TelemetryProcessor first_pass(map);
  processRows(TelemetryRows(telemetry, map, options.pose_std_m), map, first_pass, {},
              [](std::size_t, TelemetryProcessor::Result&&) {});
  DriveIntake intake(map, journal, options);
  intake.state_->put(telemetry, first_pass.verdict());
  map.publishAll();
  return intake.report();
}

DriveReport replay(TraversabilityMap& map, const EvidenceJournal& journal) {
  DriveReport report;
  for (const std::string& drive : journal.drives()) {
    if (map.drives().contains(drive)) continue;
    for (const JournalRow& row : journal.rows(drive)) {
      const bool used = row.accepted && map.learn(row.observation);
      ++(used ? report.used : report.rejected);
      if (used && row.observation.pull_may_raise) ++report.raising;
    }
    map.noteDrive(drive);
  }
  map.publishAll();
  return report;
}

}  // namespace talus::costmap
