#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <talus/costmap/telemetry/sensor_watch.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kWindow = 5;
constexpr const char* kSpike = "spike";

constexpr std::array<std::pair<const char*, double TelemetryReading::*>, 3> kSensors{
    {{"slip", &TelemetryReading::slip},
     {"torque", &TelemetryReading::torque_Nm},
     {"sinkage", &TelemetryReading::sinkage_m}}};

double medianOf(const std::deque<TelemetryReading>& last, double TelemetryReading::*field) {
  std::vector<double> values;
  for (const TelemetryReading& r : last)
    if (std::isfinite(r.*field)) values.push_back(r.*field);
  if (values.size() < kWindow) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool departs(double value, double median, double limit) {
  return std::abs(value - median) > limit;
}

bool sameNumber(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// True if two readings have equal slip, torque and sinkage.
bool sameReading(const TelemetryReading& a, const TelemetryReading& b) {
  return sameNumber(a.slip, b.slip) && sameNumber(a.torque_Nm, b.torque_Nm) &&
         sameNumber(a.sinkage_m, b.sinkage_m);
}

}  // namespace

bool SensorWatch::isSpike(const Wheel& wheel, const TelemetryReading& reading) const {
  const double radius_m = model_.rover().wheel.radius_m;
  return departs(reading.slip, medianOf(wheel.last, &TelemetryReading::slip), limits_.slip_spike) ||
         departs(reading.torque_Nm, medianOf(wheel.last, &TelemetryReading::torque_Nm),
                 limits_.torque_spike * radius_m * reading.load_N) ||
         departs(reading.sinkage_m, medianOf(wheel.last, &TelemetryReading::sinkage_m),
                 limits_.sinkage_spike * radius_m);
}

bool SensorWatch::slipsBackwardsUphill(const TelemetryReading& reading) const noexcept {
  return reading.slip < limits_.backward_slip && reading.gradient > limits_.climb &&
         !(reading.torque_Nm <= 0.0);
}

// Returns a reason if the whole reading is stuck, or one sensor that changed in most rows before. Must be
// called before the reading is stored.
std::optional<std::string> SensorWatch::stuck(Wheel& wheel, const TelemetryReading& reading) const {
  if (wheel.last.empty()) return std::nullopt;
  const TelemetryReading& before = wheel.last.back();
  wheel.equal = sameReading(before, reading) ? wheel.equal + 1 : 0;
  std::optional<std::string> reason;
  for (std::size_t i = 0; i < kSensors.size(); ++i) {
    const auto& [name, field] = kSensors[i];
    Channel& channel = wheel.channels[i];
    if (!std::isfinite(reading.*field) || !std::isfinite(before.*field)) continue;
    channel.equal = reading.*field == before.*field ? channel.equal + 1 : 0;
    const bool lively =
        channel.rows >= limits_.stuck_rows &&
        static_cast<double>(channel.changes) > limits_.lively * static_cast<double>(channel.rows);
    if (channel.equal == 0) ++channel.changes;
    if (channel.equal == 0 || !lively) ++channel.rows;
    if (lively && channel.equal + 1 >= limits_.stuck_rows) reason = std::string(name) + " is stuck";
  }
  return wheel.equal + 1 >= limits_.stuck_rows ? "readings are stuck" : reason;
}

std::vector<std::optional<std::string>> SensorWatch::refuse(const std::vector<Named>& moment) {
  std::vector<std::optional<std::string>> reasons;
  for (const Named& named : moment) reasons.push_back(judge(named));
  // If all wheels are rejected and several jump, the jumps are accepted as slip of the rover.
  const auto spikes = std::count(reasons.begin(), reasons.end(), kSpike);
  const bool all_jump = spikes > 1 && std::all_of(reasons.begin(), reasons.end(),
                                                  [](const auto& reason) { return reason.has_value(); });
  for (auto& reason : reasons)
    if (all_jump && reason == kSpike)
      reason.reset();
    else if (reason)
      ++refusals_[*reason];
  return reasons;
}

std::optional<std::string> SensorWatch::judge(const Named& named) {
  const TelemetryReading& reading = named.reading;
  Wheel& wheel = wheels_[named.wheel];
  std::optional<std::string> reason;
  if (reading.time_s < wheel.time_s) {
    wheel = Wheel{};
    ++clock_went_back_;
  }
  if (!std::isnan(reading.time_s)) wheel.time_s = reading.time_s;
  if (const auto still = stuck(wheel, reading); !reason) reason = still;
  if (!reason && isSpike(wheel, reading)) reason = kSpike;
  if (!reason && slipsBackwardsUphill(reading)) reason = "negative slip on a climb: the slip is biased";
  wheel.last.push_back(reading);
  if (wheel.last.size() > kWindow) wheel.last.pop_front();
  return reason;
}

void SensorWatch::compare(const WheelObservation& observation) {
  if (!std::isfinite(observation.from_torque) || !std::isfinite(observation.demand)) return;
  difference_sum_ += observation.from_torque - observation.demand;
  ++differences_;
}

std::optional<double> SensorWatch::bias() const {
  if (differences_ < limits_.bias_rows) return std::nullopt;
  return difference_sum_ / static_cast<double>(differences_);
}

std::vector<std::string> SensorWatch::findings() const {
  std::vector<std::string> lines;
  for (const auto& [reason, count] : refusals_) lines.push_back(std::to_string(count) + " rows: " + reason);
  if (clock_went_back_ > 0)
    lines.push_back(
        std::to_string(clock_went_back_) +
        " rows: time decreases; each begins a series of its own, and the drive raises no estimate");
  if (biased())
    lines.push_back(
        "torque and sinkage imply " + std::to_string(*bias()) +
        " DP/W more than the slope requires: a torque offset of " +
        std::to_string(*bias() * model_.rover().wheel.radius_m * terramech::wheelLoad_N(model_.rover())) +
        " Nm, or a wrong sinkage datum; both channels are excluded");
  return lines;
}

}  // namespace talus::costmap
