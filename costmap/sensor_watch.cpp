#include <algorithm>
#include <cmath>

#include <costmap/sensor_watch.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kWindow = 5;

double medianOf(const std::deque<WheelReading>& last, double WheelReading::*field) {
  std::vector<double> values;
  for (const WheelReading& r : last)
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

// A reading in which nothing is measured exactly, yet nothing moved.
bool sameReading(const WheelReading& a, const WheelReading& b) {
  return sameNumber(a.slip, b.slip) && sameNumber(a.torque_Nm, b.torque_Nm) &&
         sameNumber(a.sinkage_m, b.sinkage_m);
}

}  // namespace

bool SensorWatch::isSpike(const Wheel& wheel, const WheelReading& reading) const {
  const double radius_m = model_.rover().wheel.radius_m;
  return departs(reading.slip, medianOf(wheel.last, &WheelReading::slip), limits_.slip_spike) ||
         departs(reading.torque_Nm, medianOf(wheel.last, &WheelReading::torque_Nm),
                 limits_.torque_spike * radius_m * reading.load_N) ||
         departs(reading.sinkage_m, medianOf(wheel.last, &WheelReading::sinkage_m),
                 limits_.sinkage_spike * radius_m);
}

std::optional<std::string> SensorWatch::refuse(const std::string& name, const WheelReading& reading) {
  Wheel& wheel = wheels_[name];
  std::optional<std::string> reason;
  if (reading.time_s < wheel.time_s)
    reason = "time goes back";
  else
    wheel.time_s = std::isnan(reading.time_s) ? wheel.time_s : reading.time_s;
  wheel.equal = !wheel.last.empty() && sameReading(wheel.last.back(), reading) ? wheel.equal + 1 : 0;
  if (!reason && wheel.equal + 1 >= limits_.stuck_rows) reason = "readings are stuck";
  if (!reason && isSpike(wheel, reading)) reason = "spike";
  wheel.last.push_back(reading);
  if (wheel.last.size() > kWindow) wheel.last.pop_front();
  if (reason) ++refusals_[*reason];
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
  if (biased())
    lines.push_back(
        "torque and sinkage say " + std::to_string(*bias()) +
        " of the load more pull than the slope asks for: a torque offset of " +
        std::to_string(*bias() * model_.rover().wheel.radius_m * terramech::wheelLoad_N(model_.rover())) +
        " Nm, or a sinkage datum that is off; both are left out");
  return lines;
}

}  // namespace talus::costmap
