#include <algorithm>
#include <cmath>

#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kRemembered = 120;  // readings
constexpr std::size_t kLeast = 20;        // readings needed for a datum

double medianOf(std::deque<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Excess sinkage divided by the wheel radius, minus the wheel's own datum (the median of earlier excesses).
double WheelAlarm::excessSinkage(std::size_t wheel, const costmap::TelemetryReading& reading,
                                 const WheelExpectation& expected) {
  if (std::isnan(reading.sinkage_m) || reading.pass > 1) return 0.0;
  std::deque<double>& before = excess_[wheel];
  const double excess = reading.sinkage_m / radius_m_ - expected.sinkage_over_radius;
  const double datum = before.size() >= kLeast ? medianOf(before) : 0.0;
  before.push_back(excess);
  if (before.size() > kRemembered) before.pop_front();
  return excess - datum;
}

WheelAlarm::AlarmCheck WheelAlarm::check(const WheelMeasurements& look,
                                         const std::vector<WheelExpectation>& expected) {
  AlarmCheck check;
  excess_.resize(std::max(excess_.size(), look.wheels.size()));
  std::size_t slipping = 0, reading_slip = 0;
  double expected_angle_rad = 0.0;
  for (std::size_t w = 0; w < look.wheels.size(); ++w) {
    const costmap::TelemetryReading& reading = look.wheels[w];
    reading_slip += std::isnan(reading.slip) ? 0U : 1U;
    // The threshold is at least the limit: downhill, slip below the limit is traction even if the expected
    // slip is negative, and a rover that stops there must climb back.
    slipping += reading.slip > std::max(expected[w].slip, 0.0) + limits_.slip ? 1U : 0U;
    expected_angle_rad = std::fmax(expected_angle_rad, expected[w].slip_angle_rad);
    check.sank.push_back(excessSinkage(w, reading, expected[w]) > limits_.sinkage);
  }
  if (slipping > 0 && 2 * slipping >= reading_slip)
    check.reason = "slips";
  else if (std::abs(look.slip_angle_rad) > expected_angle_rad + limits_.slip_angle_rad)
    check.reason = "slides";
  else if (std::find(check.sank.begin(), check.sank.end(), true) != check.sank.end())
    check.reason = "sinks";
  return check;
}

}  // namespace talus::planner
