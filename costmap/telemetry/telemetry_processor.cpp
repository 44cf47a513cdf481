#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/telemetry/telemetry_processor.hpp>

namespace talus::costmap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestStdShare =
    2.0;  // limit, in units of the class's mean_std: a drive with a greater standard deviation raises no
          // estimate (ours)
constexpr double kMostCompressing =
    0.9;  // a drive whose sensor compresses large slips with a greater probability raises no estimate (ours)
constexpr std::size_t kFirstFit = 32;  // number of moments before the first fit
constexpr double kCrabbing = 0.1;      // slip angle above which a wheel does not go straight [rad]
constexpr double kSlipOfResistance =
    0.03;  // slip on level ground that ground with more resistance than its class may cause (ours)
constexpr double kLittleSlip =
    0.5;  // shared error of a reading at low slip, in units of the class's standard deviation (ours)

std::optional<int> classAt(const TraversabilityMap& map, const TelemetryReading& reading) {
  const auto cell = map.grid().cellAt(reading.place);
  const int index = cell ? map.surface().classIndex(*cell) : -1;
  return index < 0 ? std::nullopt : std::optional(index);
}

ClassReading withoutTorque(ClassReading read) {
  read.reading.torque_Nm = read.reading.sinkage_m = kNone;
  return read;
}

WheelObservation boundOf(const TelemetryReading& reading, const GroundBound& here) {
  WheelObservation out{.time_s = reading.time_s, .place = reading.place, .pull = {}, .sinkage = {}};
  out.pose_std_m = reading.pose_std_m;
  out.here = here;
  return boundAlone(out);
}

// Replaces the pull by the pull from slip and slope if lower: unverified torque and sinkage never raise a
// pull.
void weakerBySlope(WheelObservation& seen) {
  if (std::isfinite(seen.from_torque) && seen.by_slope.value < seen.pull.value) seen.pull = seen.by_slope;
}

}  // namespace

WheelObservation boundAlone(const WheelObservation& observation) {
  WheelObservation left = observation;
  left.pull = left.sinkage = left.by_slope = {kNone, kNone};
  left.from_torque = kNone;
  left.bound = left.pull_may_raise = left.sinkage_may_raise = false;
  return left;
}

TelemetryProcessor::TelemetryProcessor(const TraversabilityMap& map)
    : map_(map), danger_(map.model()), watch_(map.model()), fit_(map.model()), observer_(map.model()) {}

std::vector<TelemetryProcessor::Result> TelemetryProcessor::process(const TelemetryRows& rows,
                                                                    const Moment& moment,
                                                                    const DriveVerdict& verdict) {
  read_ += moment.readings.size();
  transferred_ += moment.transferred ? moment.readings.size() : 0;
  std::vector<SensorWatch::Named> named;
  for (std::size_t w = 0; w < moment.readings.size(); ++w)
    named.push_back({rows.series(moment.rows[w]), moment.readings[w]});
  const auto suspected = watch_.refuse(named);
  std::vector<Result> all;
  std::vector<std::size_t> sound_at;
  Sound sound;
  for (std::size_t w = 0; w < moment.readings.size(); ++w) {
    Result& result = all.emplace_back(Result{moment.readings[w]});
    const auto index = classAt(map_, result.reading);
    if (!index) {
      result.reason = "outside the map or on ground without a soil";
      result.observation = ofUnobserved(result.reading, rows.leastGradient(moment.rows[w]));
      continue;
    }
    const ClassReading read{*index, result.reading};
    const GroundBound here = bound(read, rows.leastGradient(moment.rows[w]), suspected[w].has_value());
    if (here.any()) result.observation = boundOf(result.reading, here);
    if (suspected[w]) {
      result.reason = *suspected[w];
      continue;
    }
    sound.read.push_back(read);
    sound.row.push_back(moment.rows[w]);
    sound.danger.push_back(here.any());
    sound_at.push_back(w);
  }
  auto seen = observed(sound, verdict);
  prove(rows, sound, seen);
  if (verdict.proof && !verdict.drive) refit();
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] && !torqueSound(rows, sound.row[i], verdict)) weakerBySlope(*seen[i]);
  const bool of_rover =
      carriesRover(moment.readings, map_.model().rover()) &&
      std::all_of(moment.rows.begin(), moment.rows.end(), [&](std::size_t row) { return rows.ofRover(row); });
  if (!of_rover)
    others_ += moment.readings.size();
  else if (mayRaise(rows, moment, sound, verdict))
    allow(rows, sound, verdict, seen);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Result& result = all[sound_at[i]];
    if (seen[i]) {
      if (result.observation) seen[i]->here = result.observation->here;
      result.observation = seen[i];
    } else {
      result.reason = "insufficient measurements: needs slope, torque with sinkage, or drawbar pull";
    }
  }
  return all;
}

std::optional<WheelObservation> TelemetryProcessor::rejected(const TelemetryRows& rows,
                                                             std::size_t row) const {
  const TelemetryReading reading = rows.reading(row);
  const auto index = classAt(map_, reading);
  if (!index) return ofUnobserved(reading, rows.steepestDescent(row));
  const GroundBound here = danger_.bound(*index, reading, rows.steepestDescent(row));
  return here.any() ? std::optional(boundOf(reading, here)) : std::nullopt;
}

// Returns the bound of ground without a class, evaluated as ground of the first class.
std::optional<WheelObservation> TelemetryProcessor::ofUnobserved(const TelemetryReading& reading,
                                                                 double least_gradient) const {
  const GroundBound here = danger_.bound(0, reading, least_gradient);
  return here.any() ? std::optional(boundOf(reading, here)) : std::nullopt;
}

// Returns the bound from one reading; for a suspected reading, the estimated pull is used, too.
GroundBound TelemetryProcessor::bound(const ClassReading& read, double least_gradient, bool suspected) const {
  GroundBound here = danger_.bound(read.class_index, read.reading, least_gradient);
  if (!suspected) return here;
  auto seen = observer_.observe({read}).front();
  if (!seen) return here;
  weakerBySlope(*seen);
  here.lower(danger_.bound(read.class_index, *seen).most_pull);
  return here;
}

// Caches slipOfClasses() for the wheels of a moment, which mostly have one slope.
struct TelemetryProcessor::SlipOfClasses {
  const TelemetryProcessor& processor;
  const std::vector<ClassReading>& together;
  double gradient = kNone, slip = kNone;

  double on(double of_gradient) {
    if (of_gradient != gradient) {
      gradient = of_gradient;
      slip = processor.slipOfClasses(together, gradient);
    }
    return slip;
  }
};

// Returns the joint observations of the accepted wheels; biased torque and sinkage are omitted. Readings that
// indicate danger are not used to check sensors.
std::vector<std::optional<WheelObservation>> TelemetryProcessor::observed(const Sound& sound,
                                                                          const DriveVerdict& verdict) {
  auto whole = observer_.observe(sound.read);
  SlipOfClasses of_classes{*this, sound.read};
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (sound.danger[i]) continue;
    if (whole[i]) watch_.compare(*whole[i]);
    watch_.compareSlip(sound.read[i].reading.slip - of_classes.on(sound.read[i].reading.gradient));
  }
  if (!verdict.without_torque) return whole;
  std::vector<ClassReading> without;
  for (const ClassReading& read : sound.read) without.push_back(withoutTorque(read));
  return observer_.observe(without);
}

// Adds a moment to the fit if all wheels are on one class, travel straight ahead and indicate no danger.
void TelemetryProcessor::fit(const TelemetryRows& rows, const Sound& sound) {
  if (sound.read.empty() || std::find(sound.danger.begin(), sound.danger.end(), true) != sound.danger.end())
    return;
  SlipFit::Moment moment{.run = rows.run(sound.row.front()),
                         .class_index = sound.read.front().class_index,
                         .wheels = static_cast<int>(sound.read.size()),
                         .place = sound.read.front().reading.place,
                         .gradient = rows.measuredGradient(sound.row.front())};
  for (const std::size_t row : sound.row)
    if (proof_.isSuspect(moment.run, rows.wheel(row))) return;
  for (const ClassReading& read : sound.read) {
    if (read.class_index != moment.class_index || std::abs(read.reading.slip_angle_rad) > kCrabbing) return;
    moment.rutted += read.reading.pass > 1 ? 1 : 0;
    moment.slip += read.reading.slip / moment.wheels;
  }
  fit_.take(moment);
}

// Repeats the fit each time that the number of moments has grown by a quarter, for drives added in parts.
void TelemetryProcessor::refit() {
  if (fit_.moments() < std::max(next_fit_, kFirstFit)) return;
  fitted_ = fitted();
  next_fit_ = fit_.moments() + fit_.moments() / 4;
}

std::shared_ptr<const SlipPosterior> TelemetryProcessor::fitted() const {
  return fit_.fitted([&](const std::string& run) { return proof_.gradientExcess(run); });
}

DriveVerdict TelemetryProcessor::verdict() const {
  DriveVerdict verdict = soFar();
  if (verdict.proof) verdict.drive = fitted();
  return verdict;
}

void TelemetryProcessor::prove(const TelemetryRows& rows, const Sound& sound,
                               const std::vector<std::optional<WheelObservation>>& seen) {
  fit(rows, sound);
  SlipOfClasses of_classes{*this, sound.read};
  double mean_slip = sound.read.size() > 1 ? 0.0 : kNone;
  for (const ClassReading& read : sound.read)
    mean_slip += read.reading.slip / static_cast<double>(sound.read.size());
  for (std::size_t i = 0; i < sound.read.size(); ++i) {
    const std::size_t row = sound.row[i];
    const double gradient = rows.measuredGradient(row);
    proof_.take({.run = rows.run(row),
                 .wheel = rows.wheel(row),
                 .reading = sound.read[i].reading,
                 .measured_gradient = gradient,
                 .map_gradient = rows.mapGradient(row),
                 .class_slip = of_classes.on(gradient),
                 .torque_pull = seen[i] ? seen[i]->from_torque : kNone,
                 .share = seen[i] ? seen[i]->share : 0.0,
                 .mean_slip = mean_slip,
                 .danger = sound.danger[i]});
  }
}

bool TelemetryProcessor::torqueSound(const TelemetryRows& rows, std::size_t row,
                                     const DriveVerdict& verdict) {
  return verdict.proof && verdict.proof->torqueSound(rows.run(row), rows.wheel(row));
}

bool TelemetryProcessor::mayRaise(const TelemetryRows& rows, const Moment& moment, const Sound& sound,
                                  const DriveVerdict& verdict) const {
  const std::string run = rows.run(moment.rows.front());
  const std::size_t wheels = moment.readings.size();
  const SlipPosterior* drive = verdict.drive ? verdict.drive.get() : fitted_.get();
  if (!drive || drive->compressing > kMostCompressing) return false;
  if (!verdict.proof || verdict.without_torque || proof_.displaced(run) || sound.read.size() != wheels ||
      verdict.proof->wheels(run) != wheels ||
      (wheels != 1 && wheels != static_cast<std::size_t>(map_.model().rover().wheel_count)))
    return false;
  if (std::find(sound.danger.begin(), sound.danger.end(), true) != sound.danger.end()) return false;
  return std::all_of(sound.row.begin(), sound.row.end(), [&](std::size_t row) {
    return verdict.proof->pullSound(run, rows.wheel(row)) && !proof_.isSuspect(run, rows.wheel(row));
  });
}

std::string TelemetryProcessor::whyNoneRaises() const {
  if (watch_.clockWentBack() || watch_.biased() || others_ == read_) return {};
  const SensorProof::FailedTest failedTest = proof_.failedTest();
  if (failedTest != SensorProof::FailedTest::Nothing) return SensorProof::text(failedTest);
  return fitted()->compressing > kMostCompressing
             ? "large slips are smaller than the slopes and the small slips imply; check the slip of each "
               "wheel"
             : "no moment has sound rows of all wheels of the rover, or of "
               "the only one of the file; give them all, and time_s";
}

// Replaces the observations by those from the corrected slips, relative to the mean strength of the drive,
// and marks the observations that may raise an estimate.
void TelemetryProcessor::allow(const TelemetryRows& rows, const Sound& sound, const DriveVerdict& verdict,
                               std::vector<std::optional<WheelObservation>>& seen) const {
  const SlipPosterior& drive = verdict.drive ? *verdict.drive : *fitted_;
  const double bias = std::min(drive.slip_bias, std::max(drive.slip_bias - kSlipOfResistance, 0.0));
  std::vector<ClassReading> read = sound.read;
  for (std::size_t i = 0; i < read.size(); ++i) {
    TelemetryReading& reading = read[i].reading;
    reading.slip = std::clamp((reading.slip - bias) / drive.slip_scale, -1.0, 1.0);
    reading.gradient -= std::max(verdict.proof->gradientExcess(rows.run(sound.row[i])), 0.0);
  }
  std::vector<double> departures;
  for (const Estimate& departure : drive.departure) departures.push_back(departure.value);
  const auto fitted = observer_.observe(read, departures);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Estimate& of_drive = drive.departure[static_cast<std::size_t>(read[i].class_index)];
    const double largest_std =
        kLargestStdShare *
        map_.model().parts().classes[static_cast<std::size_t>(read[i].class_index)].mean_std;
    if (!seen[i] || !fitted[i] || read[i].reading.slip >= kDangerSlip || seen[i]->bound ||
        !(of_drive.std <= largest_std) || std::isfinite(read[i].reading.drawbar_pull_N))
      continue;
    WheelObservation& one = *seen[i];
    const bool torque_sound = torqueSound(rows, sound.row[i], verdict);
    one.pull = fitted[i]->pull;
    if (!torque_sound && fitted[i]->by_slope.value < one.pull.value) one.pull = fitted[i]->by_slope;
    one.pull.value -= drive.caution[static_cast<std::size_t>(read[i].class_index)];
    one.shared_std = fitted[i]->shared_std;
    // A reading at low slip raises an estimate only if the drive has mobilised most of the thrust.
    if (std::isnan(one.shared_std) &&
        verdict.proof->mobilised(rows.run(sound.row[i]), rows.wheel(sound.row[i])))
      one.shared_std = kLittleSlip * map_.model().prior(read[i].class_index).pull.std;
    one.shared_std = std::hypot(one.shared_std, of_drive.std);
    one.pull_may_raise = std::isfinite(one.shared_std);
    one.sinkage_may_raise = torque_sound;
  }
}

// Returns the common slip of all wheels at which ground of their classes, undisturbed or in a rut, provides
// the pull of a gradient; NaN if no slip in -0.5 to 0.8 does.
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

}  // namespace talus::costmap
