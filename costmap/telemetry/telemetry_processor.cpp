#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include <talus/costmap/telemetry/telemetry_processor.hpp>

namespace talus::costmap {
namespace {

constexpr double kLastSlip = 0.8;  // slip at the end of the cost curves
constexpr double kStanding = 0.9;  // slip from which a wheel may be stationary
constexpr double kTwoStd = 0.05;   // two standard deviations of drawbar pull over load (DP/W) from one slip
                                   // and slope
constexpr double kSunk = 0.75;     // sinkage over radius from which ground is dangerous in every heading
constexpr double kBelow = 0.01;    // step in which evidence is stored, in DP/W
constexpr double kMost = 10.0;     // greatest value of either bound; greater values have no further effect

// Returns the greater of the measured slip and the slip from speeds, at most 1; NaN if both are missing.
double slipOf(const TelemetryReading& reading) noexcept {
  const double most = std::fmax(reading.slip, reading.speed_slip);
  return most > 1.0 ? 1.0 : most;
}

// Limits a bound to the range of the journal; NaN stays.
double kept(double most_pull) noexcept {
  return std::isnan(most_pull) ? most_pull : std::clamp(most_pull, -kMost, kMost);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestStdShare =
    2.0;  // in units of the class's mean_std: a drive with a greater standard deviation is not verified (ours)
constexpr double kNoStrength = 1.0;    // standard deviation of a pull that tells nothing
constexpr std::size_t kFirstFit = 32;  // number of moments before the first fit
constexpr double kCrabbing = 0.1;      // slip angle above which a wheel does not go straight [rad]
std::optional<int> classAt(const TraversabilityMap& map, const TelemetryReading& reading) {
  const auto cell = map.grid().cellAt(reading.place);
  const int index = cell ? map.surface().classIndex(*cell) : -1;
  return index < 0 ? std::nullopt : std::optional(index);
}

WheelObservation boundOf(const TelemetryReading& reading, const GroundBound& here) {
  WheelObservation out{.time_s = reading.time_s, .place = reading.place, .pull = {}, .sinkage = {}};
  out.pose_std_m = reading.pose_std_m;
  out.here = here;
  return boundAlone(out);
}

// Median of the known values; NaN without any.
double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return kNone;
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

// Returns the most probable kind of sensors of a drive, and what would settle a fault.
std::string sensorText(const DriveEstimate& drive, const char* settles) {
  static const std::map<std::string, const char*> texts{
      {"sound", "sound slip sensor"},
      {"second", "the second slip is false, by rim_speed_mps, speed_mps or positions; the first is sound"},
      {"offset", "slip has an offset, which is corrected"},
      {"step", "slip steps on the way, which is corrected"},
      {"stuck", "slip no longer depends on the ground from some place on"},
      {"scale", "slip is read too small or too large in proportion"},
      {"compressed", "large slips are read too small"},
      {"uphill", "slip is read too small on climbs"},
      {"by gradient", "slip is read too small in proportion to the slope"},
      {"of class", "slip is computed from the soil of the class instead of measured"},
      {"unrelated", "slip does not depend on the slope"}};
  if (drive.displaced_from < DriveEstimate::kParts)
    return "measured slopes do not follow those of the map from part " +
           std::to_string(drive.displaced_from + 1) + " of " + std::to_string(DriveEstimate::kParts) +
           " of the drive on: the pose is displaced, and the rows from there on tell nothing; check pose and "
           "heading_rad";
  if (drive.hypothesis.empty()) return {};
  const bool verified = drive.informing > DriveEstimate::kVerified;
  char probability[16];
  std::snprintf(probability, sizeof probability, "%.2f",
                verified ? drive.probability : 1.0 - drive.informing);
  const std::string& kind = verified ? drive.hypothesis : drive.uninforming;
  const bool tells = verified && kind != "stuck";
  return std::string(texts.at(kind)) + (drive.twice || tells ? "" : "; such rows tell nothing") +
         " (probability " + probability + ")" +
         (drive.twice || kind == "sound" || kind == "second" ? "" : settles);
}

}  // namespace

// Returns the greatest DP/W that is dangerous at a gradient, less the step in which evidence is stored.
double DangerWatch::dangerousBelow(double gradient) const noexcept {
  return std::tan(std::atan(gradient) - model_.parts().policy.slope_margin_rad) - kBelow;
}

// Returns the greatest DP/W that is dangerous in every heading: the DP/W of the steepest descent that the
// rover may drive.
double DangerWatch::dangerousInEveryHeading() const noexcept {
  return dangerousBelow(-std::tan(model_.rover().max_pitch_rad));
}

GroundBound DangerWatch::bound(int class_index, const TelemetryReading& reading,
                               double least_gradient) const {
  GroundBound bound;
  const double slip = slipOf(reading), z = reading.sinkage_m / model_.rover().wheel.radius_m;
  if (slip >= kDangerSlip) {
    const double at =
        model_.steady(class_index, {.slip = slip, .in_rut = reading.pass > 1}).drawbar_pull_over_load;
    bound.lower(model_.prior(class_index).pull.value + least_gradient - at + kTwoStd);
  }
  const bool torque_limit = std::abs(reading.torque_Nm) >= model_.rover().max_torque_Nm;
  if (slip >= kLastSlip || torque_limit) bound.lower(dangerousBelow(least_gradient));
  if (z >= model_.parts().policy.sinkage_threshold) bound.least_sinkage = std::min(z, kMost);
  if (slip >= kStanding || z >= kSunk) bound.lower(dangerousInEveryHeading());
  bound.most_pull = kept(bound.most_pull);
  return bound;
}

WheelObservation boundAlone(const WheelObservation& observation) {
  WheelObservation left = observation;
  left.pull = left.sinkage = {kNone, kNone};
  left.trust = Trust::Unverified;
  return left;
}

TelemetryProcessor::TelemetryProcessor(const TraversabilityMap& map)
    : map_(map), danger_(map.model()), posterior_(map.model()), observer_(map.model()) {}

std::vector<TelemetryProcessor::Result> TelemetryProcessor::process(const TelemetryRows& rows,
                                                                    const Moment& moment,
                                                                    const DriveVerdict& verdict) {
  settles_ = rows.settles();
  transferred_ += moment.transferred ? moment.readings.size() : 0;
  const std::vector<bool> jump = jumps(rows, moment);
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
    GroundBound here = danger_.bound(*index, result.reading, rows.leastGradient(moment.rows[w]));
    const auto alone = jump[w] ? observer_.observe({read}).front() : std::nullopt;
    if (alone && alone->pull.value < map_.model().prior(*index).pull.value)
      here.lower(kept(alone->pull.value));
    if (here.any()) result.observation = boundOf(result.reading, here);
    if (jump[w]) {
      result.reason = "the slip of this wheel jumps: it bounds its place alone";
      continue;
    }
    sound.read.push_back(read);
    sound.row.push_back(moment.rows[w]);
    sound.danger.push_back(here.any());
    sound.second.push_back(rows.secondSlip(moment.rows[w]));
    sound_at.push_back(w);
  }
  auto seen = observer_.observe(sound.read);
  const std::size_t number = posterior_.moments();
  take(rows, sound);
  if (verdict.follows && !verdict.drive) follow();
  if (verdict.drive && fitted_ != verdict.drive) sensors_ = sensorText(*(fitted_ = verdict.drive), settles_);
  const bool of_rover =
      carriesRover(moment.readings, map_.model().rover()) &&
      std::all_of(moment.rows.begin(), moment.rows.end(), [&](std::size_t row) { return rows.ofRover(row); });
  if (!of_rover)
    others_ += moment.readings.size();
  else if (fitted_)
    correct(sound, number, seen);
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

std::vector<bool> TelemetryProcessor::jumps(const TelemetryRows& rows, const Moment& moment) {
  constexpr double kJump = 0.3;
  constexpr std::size_t kLast = 5;
  std::vector<bool> jumps;
  for (std::size_t w = 0; w < moment.readings.size(); ++w) {
    std::deque<double>& last = slips_[rows.series(moment.rows[w])];
    const double slip = moment.readings[w].slip, before = median({last.begin(), last.end()});
    jumps.push_back(last.size() == kLast && std::abs(slip - before) > kJump);
    last.push_back(slip);
    if (last.size() > kLast) last.pop_front();
  }
  if (std::ranges::count(jumps, true) > 1 && std::ranges::count(jumps, false) == 0)
    jumps.assign(jumps.size(), false);
  return jumps;
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

// Adds a moment to the posterior if all wheels are on one class, travel straight ahead and indicate no danger.
void TelemetryProcessor::take(const TelemetryRows& rows, const Sound& sound) {
  if (sound.read.empty() || std::find(sound.danger.begin(), sound.danger.end(), true) != sound.danger.end())
    return;
  const std::size_t first = sound.row.front();
  DrivePosterior::Moment moment{.class_index = sound.read.front().class_index,
                                .wheels = static_cast<int>(sound.read.size()),
                                .place = sound.read.front().reading.place,
                                .gradient = rows.measuredGradient(first)};
  std::vector<double> slips;
  for (const ClassReading& read : sound.read) {
    // On a test stand, and on a rover that crabs, the pull is not that of the slope.
    if (read.class_index != moment.class_index || std::abs(read.reading.slip_angle_rad) > kCrabbing ||
        std::isfinite(read.reading.drawbar_pull_N))
      return;
    moment.rutted += read.reading.pass > 1 ? 1 : 0;
    slips.push_back(read.reading.slip);
  }
  for (const std::size_t row : sound.row)
    moment.map_gradient += rows.mapGradient(row) / static_cast<double>(sound.row.size());
  moment.slip = median(std::move(slips));
  moment.second_slip = median(sound.second);
  moment.second_std = rows.secondStd();
  posterior_.take(moment);
}

// Repeats the fit each time that the number of moments has grown by a quarter.
void TelemetryProcessor::follow() {
  if (posterior_.moments() < std::max(next_fit_, kFirstFit)) return;
  sensors_ = sensorText(*(fitted_ = std::make_shared<DriveEstimate>(posterior_.fitted())), settles_);
  next_fit_ = posterior_.moments() + posterior_.moments() / 4;
}

std::vector<std::string> TelemetryProcessor::findings() const {
  constexpr double kLeastChange = 0.05;  // least departure from a class that is reported
  std::vector<std::string> lines;
  if (!fitted_) return lines;
  if (!sensors_.empty() && !sensors_.starts_with("sound")) lines.push_back(sensors_);
  for (std::size_t c = 0; c < fitted_->classes.size(); ++c) {
    const auto index = static_cast<int>(c);
    const double counted = map_.evidence().classBelief(index).pull.value,
                 change = counted - map_.model().prior(index).pull.value;
    if (!std::isfinite(fitted_->classes[c].shared_std) || std::abs(change) < kLeastChange) continue;
    char text[120];
    std::snprintf(text, sizeof text,
                  "class %d: decisions count on DP/W %.3f, %.3f %s its soil: the ground is %s",
                  map_.model().parts().classes[c].number, counted, std::abs(change),
                  change < 0.0 ? "below" : "above", change < 0.0 ? "weaker" : "firmer");
    lines.push_back(std::string(text) +
                    (fitted_->twice ? ""
                     : change < 0.0 ? ", or slip is read too large"
                                    : ", or slip is read too small") +
                    (fitted_->twice ? "" : settles_));
  }
  return lines;
}

DriveVerdict TelemetryProcessor::verdict() const {
  return {.drive = std::make_shared<DriveEstimate>(posterior_.fitted())};
}

// Replaces the observations of the moment with a number by those from the corrected median slip and gradient,
// relative to the mean strength of the drive; by bounds alone where no slip tells about the ground.
void TelemetryProcessor::correct(const Sound& sound, std::size_t number,
                                 std::vector<std::optional<WheelObservation>>& seen) const {
  const DriveEstimate& drive = *fitted_;
  if (!drive.ground) return;
  std::vector<ClassReading> read = sound.read;
  std::vector<double> slips, departures;
  for (const ClassReading& one : read) slips.push_back(one.reading.slip);
  const double slip = median(std::move(slips)), second = median(sound.second);
  for (std::size_t c = 0; c < drive.classes.size(); ++c) {
    const auto index = static_cast<int>(c);
    departures.push_back(drive.classes[c].at + map_.model().prior(index).pull.value -
                         drive.ground->prior(index).pull.value);
  }
  std::vector<double> gains;
  for (ClassReading& one : read) {
    one.reading.gradient = drive.gradient(one.reading.gradient);
    const auto [corrected, gain] = drive.slip(number, {slip, second}, one.reading.gradient);
    one.reading.slip = std::clamp(corrected, -1.0, 1.0);
    gains.push_back(std::clamp(gain, 0.1, 1.0));
  }
  const auto corrected = WheelObserver(*drive.ground).observe(read, departures);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto index = static_cast<std::size_t>(read[i].class_index);
    const DriveEstimate::OfClass& of = drive.classes[index];
    if (!seen[i] || !std::isfinite(of.shared_std)) continue;  // no moment of the class was fitted
    if (std::isnan(read[i].reading.slip)) seen[i]->pull.std = kNoStrength;
    if (!corrected[i]) continue;
    const double largest = kLargestStdShare * map_.model().parts().classes[index].mean_std;
    const bool verified = drive.informing > DriveEstimate::kVerified && of.shared_std <= largest;
    seen[i] = corrected[i];
    seen[i]->pull.value += (verified ? of.read : of.departure.value) - of.at;
    seen[i]->pull.std /= gains[i];
    seen[i]->shared_std = of.shared_std;
    if (verified) seen[i]->trust = drive.twice ? Trust::Twice : Trust::Once;
  }
}

}  // namespace talus::costmap
