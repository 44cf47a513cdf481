#include <string>
#include <utility>

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

}  // namespace

struct DriveIntake::State {
  TraversabilityMap& map;
  EvidenceJournal* journal;
  IntakeOptions options;
  TelemetryProcessor processor;
  DriveReport report{};

  void learn(const terramech::Telemetry& telemetry, const TelemetryRows& rows, std::size_t i,
             TelemetryProcessor::Result&& result);
  void put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict);
};

void DriveIntake::State::learn(const terramech::Telemetry& telemetry, const TelemetryRows& rows,
                               std::size_t i, TelemetryProcessor::Result&& result) {
  bool accepted = result.observation.has_value();
  if (accepted && !map.learn(*result.observation)) {
    accepted = false;
    result.reason = "no ground to learn about there";
  }
  const JournalRow row{.source = telemetry.source,
                       .line = static_cast<std::int64_t>(telemetry.lines[i]),
                       .accepted = accepted,
                       .reason = result.reason,
                       .reading = rows.reading(i),
                       .observation = result.observation.value_or(WheelObservation{})};
  if (journal) journal->append(row);
  ++(accepted ? report.used : report.rejected);
  if (accepted && row.observation.pull_may_raise) ++report.raising;
  if (!accepted && report.first_reason.empty()) report.first_reason = row.reason;
}

void DriveIntake::State::put(const terramech::Telemetry& telemetry, const DriveVerdict& verdict) {
  const TelemetryRows rows(telemetry, map, options.pose_std_m);
  processRows(rows, map, processor, verdict, [&](std::size_t i, TelemetryProcessor::Result&& result) {
    learn(telemetry, rows, i, std::move(result));
  });
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
  journal.forEach([&](const JournalRow& row) {
    const bool used = row.accepted && map.learn(row.observation);
    ++(used ? report.used : report.rejected);
    if (used && row.observation.pull_may_raise) ++report.raising;
  });
  map.publishAll();
  return report;
}

}  // namespace talus::costmap
