#include <algorithm>
#include <cmath>

#include <talus/costmap/telemetry/sensor_proof.hpp>

namespace talus::costmap {
namespace {

constexpr double kApart_m = 0.5;             // least distance between rows that count as separate [m]
constexpr double kGradientVariation = 0.03;  // least standard deviation of the gradients
constexpr double kLevel = 0.08;              // gradient of ground that counts as level
constexpr std::size_t kLevelRows = 6;        // least number of rows on level ground
constexpr double kMobilised = 0.6;           // share of the thrust that counts as mobilised
constexpr double kSlipPerGradient = 0.1;     // least slope of slip over gradient, that of the firmest soil
constexpr double kPerGradient = 0.5;         // least slope of measured gradient and torque pull
constexpr double kSlopeScale = 1.15;         // greatest scale of the rover's slopes against the map's
constexpr double kSlopeBias = 0.03;          // greatest mean difference of the rover's slopes and the map's
constexpr double kSlopeScaleCertain = 2.0;   // standard errors above kSlopeScale
constexpr double kWheelScale = 0.25;         // greatest difference of a wheel's scale of slip from 1
constexpr double kWheelSpread = 0.2;         // greatest increase of the wheels' deviations with the slip
constexpr double kWheelScaleCertain = 3.0;   // standard errors above kWheelScale and kWheelSpread
constexpr double kTorqueBias = 0.08;         // greatest mean difference of one wheel's torque pull
constexpr double kJump_m = 1.5;              // three standard deviations of a good position
constexpr double kFirstStep_m = 3.0;         // greatest first step, before the speed is known
constexpr double kFaster = 3.0;              // factor on the fastest speed so far

bool isOff(const maps::Point& off) noexcept {
  return std::hypot(off.x_m, off.y_m) > kJump_m;
}

bool follows(const ResponseSeries& series, double least) {
  return series.whole().follows({.least = least, .variation = kGradientVariation});
}

// The number of last rows is small, and slip varies little on descents: half of the regression slope required
// for verification is accepted.
bool contradicts(const ResponseSeries& series, double least) {
  const Response last = series.recent(kGradientVariation);
  return last.size() >= Response::kEnough &&
         last.causeVariance() >= kGradientVariation * kGradientVariation &&
         !last.follows({.least = 0.5 * least, .variation = kGradientVariation, .certain = 2.0});
}

}  // namespace

void SensorProof::follow(Run& run, const Wheel& wheel, const TelemetryReading& reading) {
  if (!wheel.last) return;
  const double moved_m = distance_m(wheel.last->place, reading.place);
  const double passed_s = reading.time_s - wheel.last->time_s;
  const bool timed = passed_s > 0.0;
  const double known_m = timed ? kFaster * run.fastest_mps * passed_s : 0.0;
  const bool first = run.fastest_mps <= 0.0 && timed;
  if (moved_m > known_m + std::max(first ? kFirstStep_m : kJump_m, 3.0 * reading.pose_std_m)) {
    run.off.x_m += reading.place.x_m - wheel.last->place.x_m;
    run.off.y_m += reading.place.y_m - wheel.last->place.y_m;
  } else if (timed) {
    run.fastest_mps = std::max(run.fastest_mps, moved_m / passed_s);
  }
}

void SensorProof::takeLevel(Wheel& wheel, const Row& row) {
  if (!(std::abs(row.measured_gradient) <= kLevel) || !std::isfinite(row.class_slip)) return;
  ++wheel.level_rows;
  level_steps_.try_emplace(row.wheel, kLevelStep).first->second.add(row.reading.slip - row.class_slip);
}

void SensorProof::take(const Row& row) {
  Run& run = runs_[row.run];
  Wheel& wheel = run.wheels[row.wheel];
  const TelemetryReading& r = row.reading;
  follow(run, wheel, r);
  wheel.last = r;
  if (row.danger) return;
  if (wheel.last_counted && distance_m(wheel.last_counted->place, r.place) < kApart_m) return;
  wheel.last_counted = r;
  run.slope.add(row.map_gradient, row.measured_gradient);
  slopes_.add(row.map_gradient, row.measured_gradient);
  wheel.slip.add(row.measured_gradient, r.slip);
  wheel_scales_[row.wheel].add(row.mean_slip, r.slip);
  wheel_spread_.add(std::abs(row.mean_slip), std::abs(r.slip - row.mean_slip));
  wheel.torque.add(row.measured_gradient, row.torque_pull);
  wheel.mobilised_rows += row.share >= kMobilised ? 1 : 0;
  takeLevel(wheel, row);
}

const SensorProof::Run* SensorProof::find(const std::string& run) const {
  const auto at = runs_.find(run);
  return at == runs_.end() ? nullptr : &at->second;
}

const SensorProof::Wheel* SensorProof::find(const Run& run, const std::string& wheel) {
  const auto at = run.wheels.find(wheel);
  return at == run.wheels.end() ? nullptr : &at->second;
}

bool SensorProof::displaced(const std::string& run) const {
  const Run* r = find(run);
  return r && isOff(r->off);
}

double SensorProof::gradientExcess(const std::string& run) const {
  const Run* r = find(run);
  return r && r->slope.whole().size() > 0 ? r->slope.whole().meanDifference() : 0.0;
}

std::size_t SensorProof::wheels(const std::string& run) const {
  const Run* r = find(run);
  return r ? r->wheels.size() : 0;
}

// True if the measured slopes are too steep, which would make the ground appear stronger in the same
// proportion.
bool SensorProof::slopeScaled(const Run& run) const noexcept {
  // The wheels of one moment share one measured slope.
  const double certain = kSlopeScaleCertain * std::sqrt(static_cast<double>(run.wheels.size()));
  const auto scaled = [&](const Response& slope) {
    const Estimate scale = slope.slope();
    return scale.value - certain * scale.std > kSlopeScale;
  };
  return scaled(run.slope.whole()) || scaled(slopes_);
}

bool SensorProof::slipScaled(const std::string& wheel) const noexcept {
  const Estimate spread = wheel_spread_.slope();
  if (spread.value - kWheelScaleCertain * spread.std > kWheelSpread) return true;
  const auto scales = wheel_scales_.find(wheel);
  if (scales == wheel_scales_.end()) return false;
  const Estimate scale = scales->second.slope();
  return std::abs(scale.value - 1.0) - kWheelScaleCertain * scale.std > kWheelScale;
}

SensorProof::FailedTest SensorProof::failedTest(const std::string& run, const std::string& wheel) const {
  const Run* r = find(run);
  const Wheel* w = r ? find(*r, wheel) : nullptr;
  if (!w) return FailedTest::SlopeRows;
  if (isOff(r->off)) return FailedTest::Pose;
  const Response& slope = r->slope.whole();
  if (slope.size() < Response::kEnough) return FailedTest::SlopeRows;
  if (slope.causeVariance() < kGradientVariation * kGradientVariation) return FailedTest::Slopes;
  if (!follows(r->slope, kPerGradient)) return FailedTest::Slope;
  if (std::abs(slope.meanDifference()) > kSlopeBias) return FailedTest::SlopeBias;
  if (slopeScaled(*r)) return FailedTest::SlopeScale;
  if (!follows(w->slip, kSlipPerGradient)) return FailedTest::Slip;
  if (slipScaled(wheel)) return FailedTest::WheelScale;
  if (w->level_rows < kLevelRows) return FailedTest::LevelRows;
  const auto steps = level_steps_.find(wheel);
  return steps != level_steps_.end() && steps->second.step() != 0.0 ? FailedTest::SlipStep
                                                                    : FailedTest::Nothing;
}

SensorProof::FailedTest SensorProof::failedTest() const {
  for (const auto& [run, of] : runs_)
    for (const auto& [wheel, own] : of.wheels)
      if (const FailedTest what = failedTest(run, wheel); what != FailedTest::Nothing) return what;
  return FailedTest::Nothing;
}

const char* SensorProof::text(FailedTest failedTest) noexcept {
  switch (failedTest) {
    case FailedTest::Nothing:
      return "";
    case FailedTest::Pose:
      return "the pose moves further between two rows than the rover can have driven, and does not return; "
             "leave out the "
             "rows behind that, or read rows closer together";
    case FailedTest::SlopeRows:
      return "fewer than 12 rows half a metre apart have slope_rad and heading_rad; drive further, or add "
             "what lacks";
    case FailedTest::Slopes:
      return "slopes vary by less than 0.03 (standard deviation of the gradient); drive over steeper ground";
    case FailedTest::Slope:
      return "measured slopes do not follow those of the map; check pose, heading_rad and slope_rad";
    case FailedTest::SlopeBias:
      return "measured slopes differ from those of the map by more than 0.03; level the sensor";
    case FailedTest::SlopeScale:
      return "measured slopes are more than 1.15 times those of the map; check the scale of slope_rad, or "
             "give a "
             "finer elevation map";
    case FailedTest::Slip:
      return "slip does not follow the slope; check the slip of each wheel";
    case FailedTest::WheelScale:
      return "slips of the wheels of one moment are not proportional to each other; check the slip of each "
             "wheel";
    case FailedTest::LevelRows:
      return "fewer than 6 rows half a metre apart on level ground; include level ground";
    case FailedTest::SlipStep:
      return "slip on level ground steps on the way; give the rows before and behind the step as two files";
  }
  return "";
}

bool SensorProof::torqueSound(const std::string& run, const std::string& wheel) const {
  if (!pullSound(run, wheel)) return false;
  const ResponseSeries& torque = find(*find(run), wheel)->torque;
  return follows(torque, kPerGradient) && std::abs(torque.whole().meanDifference()) <= kTorqueBias;
}

bool SensorProof::isSuspect(const std::string& run, const std::string& wheel) const {
  const Run* r = find(run);
  const Wheel* w = r ? find(*r, wheel) : nullptr;
  if (!w || isOff(r->off)) return true;
  return contradicts(r->slope, kPerGradient) || contradicts(w->slip, kSlipPerGradient);
}

bool SensorProof::mobilised(const std::string& run, const std::string& wheel) const {
  const Run* r = find(run);
  const Wheel* w = r ? find(*r, wheel) : nullptr;
  return w && w->mobilised_rows >= kLevelRows;
}

}  // namespace talus::costmap
