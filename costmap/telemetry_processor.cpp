#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/telemetry_processor.hpp>

namespace talus::costmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDangerSlip = 0.7;  // beyond any that a drive plans
constexpr double kFarBelow = 2.0;    // standard deviations

std::optional<int> classAt(const TraversabilityMap& map, const WheelReading& reading) {
  const auto cell = map.grid().cellAt(reading.place);
  const int index = cell ? map.classIndex(*cell, reading.z_m) : -1;
  return index < 0 ? std::nullopt : std::optional(index);
}

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

// Torque and sinkage that are not proven make nothing stronger than slip and slope do.
void weakerBySlope(WheelObservation& seen) {
  if (std::isfinite(seen.from_torque) && seen.by_slope.value < seen.pull.value) seen.pull = seen.by_slope;
}

}  // namespace

TelemetryProcessor::TelemetryProcessor(const TraversabilityMap& map)
    : map_(map), watch_(map.model()), observer_(map.model()) {}

std::vector<TelemetryProcessor::Result> TelemetryProcessor::process(const TelemetryRows& rows,
                                                                    const Moment& moment,
                                                                    const DriveVerdict& verdict) {
  transferred_ += moment.transferred ? moment.readings.size() : 0;
  std::vector<SensorWatch::Named> named;
  for (std::size_t w = 0; w < moment.readings.size(); ++w)
    named.push_back({rows.series(moment.first + w), moment.readings[w]});
  const auto suspected = watch_.refuse(named);
  std::vector<Result> all;
  Sound sound;
  for (std::size_t w = 0; w < moment.readings.size(); ++w) {
    Result& result = all.emplace_back(Result{moment.readings[w]});
    const auto index = classAt(map_, result.reading);
    if (!index) {
      result.reason = "outside the map or on ground without a soil";
    } else if (suspected[w]) {
      result.reason = *suspected[w];
      result.observation = danger({*index, result.reading});
    } else {
      sound.read.push_back({*index, result.reading});
      sound.row.push_back(moment.first + w);
    }
  }
  auto seen = observed(sound.read, verdict);
  prove(rows, sound, seen);
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] && !torqueSound(rows, sound.row[i], verdict)) weakerBySlope(*seen[i]);
  if (mayRaise(rows, moment, sound, verdict)) allow(rows, sound, verdict, seen);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Result& result = all[sound.row[i] - moment.first];
    result.observation = seen[i];
    if (!seen[i])
      result.reason = "insufficient measurements: needs slope, torque with sinkage, or drawbar pull";
  }
  return all;
}

// Of a wheel that is suspected, by itself.
std::optional<WheelObservation> TelemetryProcessor::danger(const ClassReading& read) const {
  auto seen = observer_.observe({read}).front();
  if (seen) weakerBySlope(*seen);
  return seen && pointsToDanger(map_.model(), read, *seen) ? seen : std::nullopt;
}

// Of sound wheels together; where torque and sinkage are off, without them, but for what points to danger.
std::vector<std::optional<WheelObservation>> TelemetryProcessor::observed(
    const std::vector<ClassReading>& sound, const DriveVerdict& verdict) {
  auto whole = observer_.observe(sound);
  for (const auto& seen : whole)
    if (seen) watch_.compare(*seen);
  for (const ClassReading& read : sound) watch_.compareSlip(read.reading.slip - asked(read));
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

void TelemetryProcessor::prove(const TelemetryRows& rows, const Sound& sound,
                               const std::vector<std::optional<WheelObservation>>& seen) {
  for (std::size_t i = 0; i < sound.read.size(); ++i) {
    const std::size_t row = sound.row[i];
    const double gradient = rows.measuredGradient(row);
    proof_.take({.run = rows.run(row),
                 .wheel = rows.wheel(row),
                 .reading = sound.read[i].reading,
                 .measured_gradient = gradient,
                 .map_gradient = rows.mapGradient(row),
                 .class_slip = slipOfClasses(sound.read, gradient),
                 .torque_pull = seen[i] ? seen[i]->from_torque : kNone});
  }
}

bool TelemetryProcessor::torqueSound(const TelemetryRows& rows, std::size_t row,
                                     const DriveVerdict& verdict) {
  return verdict.proof && verdict.proof->torqueSound(rows.run(row), rows.wheel(row));
}

bool TelemetryProcessor::mayRaise(const TelemetryRows& rows, const Moment& moment, const Sound& sound,
                                  const DriveVerdict& verdict) const {
  const std::string run = rows.run(moment.first);
  const std::size_t wheels = moment.readings.size();
  if (!verdict.proof || verdict.without_torque || proof_.displaced(run) || sound.read.size() != wheels ||
      verdict.proof->wheels(run) != wheels ||
      (wheels != 1 && wheels != static_cast<std::size_t>(map_.model().rover().wheel_count)))
    return false;
  return std::all_of(sound.row.begin(), sound.row.end(), [&](std::size_t row) {
    return verdict.proof->pullSound(run, rows.wheel(row)) && !proof_.doubted(run, rows.wheel(row));
  });
}

// What is left of more strength than the class's if sensors are off by what passes as sound; the rest is doubt.
void TelemetryProcessor::allow(const TelemetryRows& rows, const Sound& sound, const DriveVerdict& verdict,
                               std::vector<std::optional<WheelObservation>>& seen) const {
  std::vector<ClassReading> off;
  for (std::size_t i = 0; i < sound.read.size(); ++i) {
    ClassReading& read = off.emplace_back(sound.read[i]);
    const double low = std::max(verdict.proof->lowSlip(rows.run(sound.row[i]), rows.wheel(sound.row[i])),
                                proof_.lowSlip(rows.run(sound.row[i]), rows.wheel(sound.row[i])));
    read.reading.slip = std::min(read.reading.slip + low + SensorProof::kLevelSlip, 1.0);
    read.reading.gradient -= std::max(verdict.proof->gradientExcess(rows.run(sound.row[i])), 0.0);
  }
  const auto least = observer_.observe(off);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool near_limit = off[i].reading.slip >= kDangerSlip;
    if (!seen[i] || !least[i] || near_limit || seen[i]->bound ||
        std::isfinite(sound.read[i].reading.drawbar_pull_N))
      continue;
    WheelObservation& one = *seen[i];
    const bool torque_sound = torqueSound(rows, sound.row[i], verdict);
    WheelObservation left = *least[i];
    if (!torque_sound) weakerBySlope(left);
    const double prior = map_.model().prior(sound.read[i].class_index).pull.value;
    const double most = off[i].reading.gradient > 0.0 ? std::max(prior, left.pull.value) : prior;
    const double kept = std::min(one.pull.value, most);
    one.pull = {kept, std::hypot(one.pull.std, one.pull.value - kept)};
    one.pull_may_raise = true;
    one.sinkage_may_raise = torque_sound;
  }
}

// Slip, the same of all wheels, at which fresh or rutted ground of their classes gives the pull of a gradient;
// NaN where none does.
double TelemetryProcessor::slipOfClasses(const std::vector<ClassReading>& together, double gradient) const {
  const auto pull = [&](double slip) {
    double load_N = 0.0, sum = 0.0;
    for (const ClassReading& read : together) {
      load_N += read.reading.load_N;
      sum += read.reading.load_N *
             map_.model().steady(read.class_index, {.slip = slip, .in_rut = read.reading.pass > 1}).gradient;
    }
    return sum / load_N;
  };
  double low = -0.5, high = 0.8;
  if (!(pull(low) <= gradient && pull(high) >= gradient)) return kNone;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (pull(middle) < gradient ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Slip of fresh ground of the class on the reading's slope; NaN where none is known or none holds it.
double TelemetryProcessor::asked(const ClassReading& read) const {
  const GroundModel& model = map_.model();
  if (std::isnan(read.reading.gradient) || read.reading.pass > 1) return kNone;
  const DriveState state =
      model.state(read.class_index, model.prior(read.class_index), read.reading.gradient);
  return state.refusal == Refusal::Pull ? kNone : static_cast<double>(state.slip);
}

}  // namespace talus::costmap
