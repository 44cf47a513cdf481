#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <talus/costmap/drive_evidence.hpp>
#include <talus/costmap/sensor_proof.hpp>
#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::costmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The columns of a telemetry file as readings.
class Rows {
 public:
  Rows(const terramech::Telemetry& telemetry, const TraversabilityMap& map, const IntakeOptions& options)
      : map_(map),
        options_(options),
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
        wheel_(telemetry.findWords("wheel")),
        run_(telemetry.findWords("run")) {}

  std::size_t size() const noexcept { return x_.size(); }

  WheelReading reading(std::size_t i) const {
    WheelReading r{
        .time_s = value(time_, i),
        .place = {x_[i], y_[i]},
        .z_m = value(z_, i),
        .load_N = load_[i],
        .slip = slip_[i],
        .torque_Nm = value(torque_, i),
        .sinkage_m = value(sinkage_, i),
        .gradient = std::tan(value(slope_, i)),
        .drawbar_pull_N = value(pull_, i),
        .pose_std_m = std::isfinite(value(pose_, i)) ? std::max(value(pose_, i), 0.0) : options_.pose_std_m,
        .pass = 1};
    if (std::isfinite(value(pass_, i))) r.pass = static_cast<int>(value(pass_, i));
    if (std::isnan(r.gradient)) r.gradient = mapGradient(r, heading(i));
    return r;
  }

  double heading(std::size_t i) const { return value(heading_, i); }
  std::string wheel(std::size_t i) const { return wheel_ ? (*wheel_)[i] : std::string(); }
  std::string run(std::size_t i) const { return run_ ? (*run_)[i] : std::string(); }
  // Along the heading: as the rover measured it, and as the map has it.
  double measuredGradient(std::size_t i) const { return std::tan(value(slope_, i)); }
  double mapGradient(std::size_t i) const { return mapGradient(reading(i), heading(i)); }

  // Wheel and run together name a series in time.
  std::string series(std::size_t i) const { return run(i) + '/' + wheel(i); }

  // One past the last row that was read at the same moment of the same run as this one, by another wheel.
  std::size_t endOfMoment(std::size_t first) const {
    std::size_t end = first + 1;
    if (!time_ || !wheel_ || !std::isfinite(value(time_, first))) return end;
    const auto seen = [&](std::size_t i) {
      for (std::size_t j = first; j < i; ++j)
        if (wheel(j) == wheel(i)) return true;
      return false;
    };
    while (end < size() && value(time_, end) == value(time_, first) && run(end) == run(first) && !seen(end))
      ++end;
    return end;
  }

 private:
  static double value(const std::vector<double>* column, std::size_t i) {
    return column ? (*column)[i] : kNone;
  }

  // Of the top surface: that of a floor beneath it is not known.
  double mapGradient(const WheelReading& r, double heading_rad) const {
    const auto cell = map_.grid().cellAt(r.place);
    if (!cell || std::isnan(heading_rad) || map_.floorAt(*cell, r.z_m)) return kNone;
    const CellCode code = map_.code(*cell);
    return code.dzDx() * std::cos(heading_rad) + code.dzDy() * std::sin(heading_rad);
  }

  const TraversabilityMap& map_;
  const IntakeOptions& options_;
  const std::vector<double>&x_, &y_, &load_, &slip_;
  const std::vector<double>*time_, *torque_, *sinkage_, *z_, *slope_, *heading_, *pull_, *pass_, *pose_;
  const std::vector<std::string>*wheel_, *run_;
};

std::optional<int> classAt(const TraversabilityMap& map, const WheelReading& reading) {
  const auto cell = map.grid().cellAt(reading.place);
  const int index = cell ? map.classIndex(*cell, reading.z_m) : -1;
  return index < 0 ? std::nullopt : std::optional(index);
}

// The readings of one moment, with the loads that the slope gives them where the file has all wheels carry
// the same: such a column is the weight's even share and not a measurement.
struct Moment {
  std::size_t first = 0;
  std::vector<WheelReading> readings;
  bool transferred = false;
};

constexpr double kSameLoad = 0.01;       // of the load: less is the same number
constexpr double kLevelGradient = 0.03;  // less moves no load worth speaking of

Moment momentAt(const Rows& rows, std::size_t first, const terramech::Rover& rover) {
  Moment moment{.first = first, .readings = {}};
  maps::Point middle{0.0, 0.0};
  const std::size_t end = rows.endOfMoment(first);
  bool same = true;
  for (std::size_t i = first; i < end; ++i) {
    const WheelReading& r = moment.readings.emplace_back(rows.reading(i));
    middle.x_m += r.place.x_m / static_cast<double>(end - first);
    middle.y_m += r.place.y_m / static_cast<double>(end - first);
    const double even_N = terramech::wheelLoad_N(rover);
    same =
        same && std::abs(r.load_N - even_N) < kSameLoad * even_N && r.gradient == moment.readings[0].gradient;
  }
  const double gradient = moment.readings[0].gradient, heading = rows.heading(first);
  const bool whole = moment.readings.size() == static_cast<std::size_t>(rover.wheel_count);
  if (!same || !whole || !(std::abs(gradient) > kLevelGradient) || std::isnan(heading)) return moment;
  std::vector<double> along_m;
  for (const WheelReading& r : moment.readings)
    along_m.push_back((r.place.x_m - middle.x_m) * std::cos(heading) +
                      (r.place.y_m - middle.y_m) * std::sin(heading));
  const std::vector<double> loads_N = terramech::wheelLoads_N(rover, gradient, along_m);
  for (std::size_t w = 0; w < loads_N.size(); ++w) moment.readings[w].load_N = loads_N[w];
  moment.transferred = true;
  return moment;
}

constexpr double kDangerSlip = 0.7;  // beyond any that a drive plans
constexpr double kFarBelow = 2.0;    // standard deviations

// Whether a reading is evidence of danger, whatever else it is suspected of.
bool pointsToDanger(const GroundModel& model, const ClassReading& read, const WheelObservation& seen) {
  const double z = read.reading.sinkage_m / model.rover().wheel.radius_m;
  const double class_std = model.parts().classes[static_cast<std::size_t>(read.class_index)].pull_std;
  const double below = model.prior(read.class_index).pull.value - seen.pull.value;
  return read.reading.slip >= kDangerSlip || z >= model.parts().policy.sinkage_threshold ||
         std::abs(read.reading.torque_Nm) >= model.rover().max_torque_Nm ||
         below > kFarBelow * std::hypot(seen.pull.std, class_std);
}

ClassReading withoutTorque(ClassReading read) {
  read.reading.torque_Nm = read.reading.sinkage_m = kNone;
  return read;
}

// What a drive is judged by: its own rows so far, or those of a first pass.
struct Verdict {
  bool without_torque = false;  // torque and sinkage are off: they count only where they point to danger
  const SensorProof* proof = nullptr;
};

// Puts the moments of a drive through watch and observer, one after the other.
class TelemetryProcessor {
 public:
  explicit TelemetryProcessor(const TraversabilityMap& map)
      : map_(map), watch_(map.model()), observer_(map.model()) {}

  // Of one wheel: why it is not believed, or only as evidence of danger, and what it says if it is.
  struct Result {
    WheelReading reading;
    std::string reason{};
    std::optional<WheelObservation> observation{};
  };

  // Calls take(row, result) for every row in order.
  template <typename Take>
  void processRows(const Rows& rows, const Verdict& verdict, Take&& take) {
    for (std::size_t first = 0; first < rows.size();) {
      const Moment moment = momentAt(rows, first, map_.model().rover());
      transferred_ += moment.transferred ? moment.readings.size() : 0;
      for (Result& result : process(rows, moment, verdict)) take(first++, std::move(result));
    }
  }

  Verdict verdict() const noexcept { return {watch_.biased(), &proof_}; }
  const SensorWatch& watch() const noexcept { return watch_; }
  std::size_t transferred() const noexcept { return transferred_; }

 private:
  std::vector<Result> process(const Rows& rows, const Moment& moment, const Verdict& verdict) {
    std::vector<SensorWatch::Named> named;
    for (std::size_t w = 0; w < moment.readings.size(); ++w)
      named.push_back({rows.series(moment.first + w), moment.readings[w]});
    const auto suspected = watch_.refuse(named);
    std::vector<Result> all;
    std::vector<ClassReading> sound;
    std::vector<std::size_t> who;
    for (std::size_t w = 0; w < moment.readings.size(); ++w) {
      Result& result = all.emplace_back(Result{moment.readings[w]});
      const auto index = classAt(map_, result.reading);
      if (!index) {
        result.reason = "outside the map or on ground without a soil";
      } else if (suspected[w]) {
        result.reason = *suspected[w];
        result.observation = danger({*index, result.reading});
      } else {
        sound.push_back({*index, result.reading});
        who.push_back(w);
      }
    }
    const auto seen = observed(sound, verdict);
    for (std::size_t i = 0; i < who.size(); ++i) {
      Result& result = all[who[i]];
      result.observation = seen[i];
      prove(rows, moment.first + who[i], sound[i], seen[i]);
      if (!seen[i])
        result.reason = "says nothing: neither slope, nor torque with sinkage, nor drawbar pull";
      else
        allow(rows, moment.first + who[i], verdict, *result.observation);
    }
    return all;
  }

  // Of a wheel that is suspected, by itself.
  std::optional<WheelObservation> danger(const ClassReading& read) const {
    auto seen = observer_.observe({read}).front();
    return seen && pointsToDanger(map_.model(), read, *seen) ? seen : std::nullopt;
  }

  // Of sound wheels together; where torque and sinkage are off, without them, but for what points to danger.
  std::vector<std::optional<WheelObservation>> observed(const std::vector<ClassReading>& sound,
                                                        const Verdict& verdict) {
    auto whole = observer_.observe(sound);
    for (const auto& seen : whole)
      if (seen) watch_.compare(*seen);
    for (const auto& [index, reading] : sound) watch_.compareSlip(reading.slip - asked(index, reading));
    if (!verdict.without_torque) return whole;
    std::vector<ClassReading> without;
    for (const ClassReading& read : sound) without.push_back(withoutTorque(read));
    auto seen = observer_.observe(without);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (whole[i] && pointsToDanger(map_.model(), sound[i], *whole[i]) &&
          (!seen[i] || whole[i]->pull.value < seen[i]->pull.value || std::isfinite(whole[i]->sinkage.std)))
        seen[i] = whole[i];
    return seen;
  }

  void prove(const Rows& rows, std::size_t row, const ClassReading& read,
             const std::optional<WheelObservation>& seen) {
    const GroundModel& model = map_.model();
    const auto level = model.state(read.class_index, model.prior(read.class_index), 0.0);
    proof_.take({.run = rows.run(row),
                 .wheel = rows.wheel(row),
                 .reading = read.reading,
                 .measured_gradient = rows.measuredGradient(row),
                 .map_gradient = rows.mapGradient(row),
                 .level_slip = static_cast<double>(level.slip),
                 .torque_pull = seen ? seen->from_torque : kNone});
  }

  // Torque and sinkage that are off raise nothing.
  void allow(const Rows& rows, std::size_t row, const Verdict& verdict, WheelObservation& seen) const {
    if (!verdict.proof || proof_.displaced(rows.run(row))) return;
    const bool with_torque = std::isfinite(seen.from_torque);
    seen.pull_may_raise =
        verdict.proof->pullSound(rows.run(row), rows.wheel(row)) && !(with_torque && verdict.without_torque);
    seen.sinkage_may_raise =
        !verdict.without_torque && verdict.proof->sinkageSound(rows.run(row), rows.wheel(row));
  }

  // Slip of fresh ground of the class on the reading's slope; NaN where none is known or none holds it.
  double asked(int class_index, const WheelReading& reading) const {
    const GroundModel& model = map_.model();
    if (std::isnan(reading.gradient) || reading.pass > 1) return kNone;
    const DriveState state = model.state(class_index, model.prior(class_index), reading.gradient);
    return state.refusal == Refusal::Pull ? kNone : static_cast<double>(state.slip);
  }

  const TraversabilityMap& map_;
  SensorWatch watch_;
  SensorProof proof_;
  WheelObserver observer_;
  std::size_t transferred_ = 0;
};

}  // namespace

struct DriveIntake::State {
  TraversabilityMap& map;
  EvidenceJournal* journal;
  IntakeOptions options;
  TelemetryProcessor processor;
  DriveReport report{};

  void put(const terramech::Telemetry& telemetry, const Verdict& verdict);
};

void DriveIntake::State::put(const terramech::Telemetry& telemetry, const Verdict& verdict) {
  const Rows rows(telemetry, map, options);
  processor.processRows(rows, verdict, [&](std::size_t i, TelemetryProcessor::Result&& result) {
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
    report.findings.push_back(
        std::to_string(rows) +
        " rows: load_N is the even share of the weight on a slope; the load transfer was "
        "worked out from the wheels' places");
  return report;
}

DriveReport addDrive(TraversabilityMap& map, const terramech::Telemetry& telemetry, EvidenceJournal* journal,
                     const IntakeOptions& options) {
  // The first pass: do torque and sinkage have a bias that all ground shares, and which sensors prove sound?
  TelemetryProcessor first_pass(map);
  first_pass.processRows(Rows(telemetry, map, options), {false, nullptr},
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
