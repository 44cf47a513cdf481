#include <algorithm>
#include <cmath>

#include <talus/costmap/sensor_proof.hpp>

namespace talus::costmap {
namespace {

constexpr double kApart_m = 0.5;             // rows nearer to each other say the same
constexpr std::size_t kRows = 12;            // of them, before anything is proven
constexpr double kCertain = 4.0;             // standard errors
constexpr double kGradientVariation = 0.03;  // of the slopes that prove a sensor, one standard deviation
constexpr double kLevel = 0.05;              // gradient of ground that counts as level
constexpr std::size_t kLevelRows = 4;
constexpr double kSlipBias = 0.03;        // below what level ground takes
constexpr double kSlipPerGradient = 0.1;  // of the firmest soil
constexpr double kSlopeBias = 0.03;       // of the rover's slope against the map's
constexpr double kTorqueBias = 0.08;      // of one wheel's share of the pull
constexpr double kJump_m = 1.5;           // that three deviations of a good pose explain
constexpr double kFirstStep_m = 3.0;      // that tells how fast the rover is
constexpr double kFaster = 3.0;           // than the fastest row before

double distance_m(const maps::Point& a, const maps::Point& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

bool isOff(const maps::Point& off) noexcept {
  return std::hypot(off.x_m, off.y_m) > kJump_m;
}

}  // namespace

void Response::add(double cause, double effect) noexcept {
  if (!std::isfinite(cause) || !std::isfinite(effect)) return;
  ++count_;
  cause_ += cause;
  effect_ += effect;
  causes_ += cause * cause;
  effects_ += effect * effect;
  product_ += cause * effect;
}

bool Response::follows(double least, double variation) const noexcept {
  if (count_ < kRows) return false;
  const double n = static_cast<double>(count_);
  const double cause = causes_ / n - cause_ * cause_ / (n * n);
  if (cause < variation * variation) return false;
  const double slope = (product_ / n - cause_ * effect_ / (n * n)) / cause;
  const double left = std::max(effects_ / n - effect_ * effect_ / (n * n) - slope * slope * cause, 0.0);
  return slope >= least + kCertain * std::sqrt(left / ((n - 2.0) * cause)) - 1e-12;
}

double Response::meanDifference() const noexcept {
  return (effect_ - cause_) / static_cast<double>(count_);
}

void SensorProof::follow(Run& run, Wheel& wheel, const WheelReading& reading) {
  if (!wheel.last) return;
  const double moved_m = distance_m(wheel.last->place, reading.place);
  const double passed_s = reading.time_s - wheel.last->time_s;
  const bool timed = passed_s > 0.0;
  const double known_m = timed ? kFaster * run.fastest_mps * passed_s : 0.0;
  const bool first = run.fastest_mps <= 0.0 && timed;
  if (moved_m > known_m + std::max(first ? kFirstStep_m : kJump_m, 3.0 * reading.pose_std_m)) {
    ++jumps_;
    run.off.x_m += reading.place.x_m - wheel.last->place.x_m;
    run.off.y_m += reading.place.y_m - wheel.last->place.y_m;
  } else if (timed) {
    run.fastest_mps = std::max(run.fastest_mps, moved_m / passed_s);
  }
}

void SensorProof::take(const Row& row) {
  Run& run = runs_[row.run];
  Wheel& wheel = wheels_[row.run + '/' + row.wheel];
  const WheelReading& r = row.reading;
  follow(run, wheel, r);
  wheel.last = r;
  if (wheel.last_counted && distance_m(wheel.last_counted->place, r.place) < kApart_m) return;
  wheel.last_counted = r;
  run.slope.add(row.map_gradient, row.measured_gradient);
  if (r.pass > 1) return;
  wheel.slip.add(row.measured_gradient, r.slip);
  wheel.torque.add(row.measured_gradient, row.torque_pull);
  if (std::abs(row.measured_gradient) > kLevel || !std::isfinite(row.level_slip)) return;
  ++wheel.level_rows;
  wheel.level_excess += r.slip - row.level_slip;
}

bool SensorProof::displaced(const std::string& run) const {
  const auto at = runs_.find(run);
  return at != runs_.end() && isOff(at->second.off);
}

bool SensorProof::placeSound(const Run& run) const noexcept {
  return !isOff(run.off) && run.slope.follows(0.5, kGradientVariation) &&
         std::abs(run.slope.meanDifference()) <= kSlopeBias;
}

bool SensorProof::pullSound(const std::string& run, const std::string& wheel) const {
  const auto at = runs_.find(run);
  const auto on = wheels_.find(run + '/' + wheel);
  if (at == runs_.end() || on == wheels_.end() || !placeSound(at->second)) return false;
  const Wheel& w = on->second;
  return w.slip.follows(kSlipPerGradient, kGradientVariation) && w.level_rows >= kLevelRows &&
         w.level_excess >= -kSlipBias * static_cast<double>(w.level_rows);
}

bool SensorProof::sinkageSound(const std::string& run, const std::string& wheel) const {
  if (!pullSound(run, wheel)) return false;
  const Wheel& w = wheels_.at(run + '/' + wheel);
  return w.torque.follows(0.5, kGradientVariation) && std::abs(w.torque.meanDifference()) <= kTorqueBias;
}

}  // namespace talus::costmap
